#include "measures/capability.hpp"

namespace fast_edi {

bool isAvailable(OptionalLibrary library) {
  switch (library) {
    // Which branches are alike depends on what is installed. NOLINTNEXTLINE(bugprone-branch-clone)
    case OptionalLibrary::kOpencvQuality:
#ifdef FAST_EDI_HAVE_OPENCV_QUALITY
      return true;
#else
      return false;
#endif
    case OptionalLibrary::kDlib:
#ifdef FAST_EDI_HAVE_DLIB
      return true;
#else
      return false;
#endif
    case OptionalLibrary::kLibsvm:
#ifdef FAST_EDI_HAVE_LIBSVM
      return true;
#else
      return false;
#endif
  }
  return false;
}

const char* toString(OptionalLibrary library) {
  switch (library) {
    case OptionalLibrary::kOpencvQuality:
      return "OpenCV's quality module (libopencv-contrib-dev)";
    case OptionalLibrary::kDlib:
      return "dlib (libdlib-dev)";
    case OptionalLibrary::kLibsvm:
      return "libsvm (libsvm-dev)";
  }
  return "unknown library";
}

void require(OptionalLibrary library, const std::string& measure) {
  if (!isAvailable(library)) {
    throw UnavailableError(measure + " needs " + toString(library) +
                           ", which was not found when this program was built");
  }
}

}  // namespace fast_edi
