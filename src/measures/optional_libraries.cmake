# Libraries that some measures of fast_edi_evaluation need and not every distribution ships. What is
# missing is told here once, and by `evaluate` in each report.

if(TARGET opencv_quality)
  target_link_libraries(fast_edi_evaluation opencv_quality)
  target_compile_definitions(fast_edi_evaluation PRIVATE FAST_EDI_HAVE_OPENCV_QUALITY)
else()
  message(STATUS "OpenCV's quality module not found: no SSIM, no BRISQUE")
endif()

# dlib's own CMake package asks for the development files of libraries that SURF does not use.
find_path(DLIB_INCLUDE_DIR dlib/image_keypoint.h)
find_library(DLIB_LIBRARY dlib)
find_library(DLIB_BLAS_LIBRARY blas)
find_library(DLIB_LAPACK_LIBRARY lapack)
if(DLIB_INCLUDE_DIR AND DLIB_LIBRARY AND DLIB_BLAS_LIBRARY AND DLIB_LAPACK_LIBRARY)
  target_include_directories(fast_edi_evaluation SYSTEM PRIVATE ${DLIB_INCLUDE_DIR})
  target_link_libraries(fast_edi_evaluation
    ${DLIB_LIBRARY} ${DLIB_LAPACK_LIBRARY} ${DLIB_BLAS_LIBRARY})
  target_compile_definitions(fast_edi_evaluation PRIVATE FAST_EDI_HAVE_DLIB)
else()
  message(STATUS "dlib with BLAS and LAPACK not found: no SURF")
endif()

find_path(LIBSVM_INCLUDE_DIR svm.h PATH_SUFFIXES libsvm)
find_library(LIBSVM_LIBRARY svm)
if(LIBSVM_INCLUDE_DIR AND LIBSVM_LIBRARY)
  target_include_directories(fast_edi_evaluation SYSTEM PRIVATE ${LIBSVM_INCLUDE_DIR})
  target_link_libraries(fast_edi_evaluation ${LIBSVM_LIBRARY})
  target_compile_definitions(fast_edi_evaluation PRIVATE FAST_EDI_HAVE_LIBSVM)
else()
  message(STATUS "libsvm not found: no SSEQ")
endif()
