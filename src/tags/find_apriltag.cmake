# The target apriltag::apriltag. The packages of Ubuntu 20.04 and Debian 11 (libapriltag 0.10) have no
# CMake configuration; ros-noetic-apriltag and Debian 12 do.
find_package(apriltag QUIET)
if(NOT TARGET apriltag::apriltag)
  find_path(APRILTAG_INCLUDE_DIR apriltag/apriltag.h)
  find_library(APRILTAG_LIBRARY apriltag)
  if(NOT APRILTAG_INCLUDE_DIR OR NOT APRILTAG_LIBRARY)
    message(FATAL_ERROR "libapriltag not found: neither its CMake configuration nor apriltag/apriltag.h and the "
      "library (libapriltag-dev, ros-noetic-apriltag)")
  endif()
  add_library(apriltag::apriltag UNKNOWN IMPORTED)
  set_target_properties(apriltag::apriltag PROPERTIES
    IMPORTED_LOCATION "${APRILTAG_LIBRARY}"
    INTERFACE_INCLUDE_DIRECTORIES "${APRILTAG_INCLUDE_DIR}")
endif()

get_target_property(apriltag_include_dirs apriltag::apriltag INTERFACE_INCLUDE_DIRECTORIES)
find_file(APRILTAG_36H10_HEADER apriltag/tag36h10.h PATHS ${apriltag_include_dirs})
if(NOT APRILTAG_36H10_HEADER)
  message(STATUS "libapriltag is older than 3.2: no tags of the family 36h10")
endif()
