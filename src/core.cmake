# The core: the method, without ROS, OpenCV and catkin. The package includes this file, and so does
# test/arm64/cross, which builds the core alone for another processor. Needs the target Eigen3::Eigen.

option(FAST_EDI_SCALAR "Build the kernels' scalar paths, as on processors without SSE2 or AVX2" OFF)
if(FAST_EDI_SCALAR)
  add_compile_definitions(FAST_EDI_SCALAR)
endif()

# Its folders, in the order in which each may use those before it.
set(FAST_EDI_CORE_ROOMS base events integral filters latent reblur video parameters exposure calibration pipeline)
set(FAST_EDI_ROOT ${CMAKE_CURRENT_LIST_DIR}/..)

# Sources of the folders of src/ that a library is made of.
function(sources_of_rooms result)
  set(sources "")
  foreach(room IN LISTS ARGN)
    file(GLOB room_sources CONFIGURE_DEPENDS ${FAST_EDI_ROOT}/src/${room}/*.cpp)
    list(APPEND sources ${room_sources})
  endforeach()
  set(${result} ${sources} PARENT_SCOPE)
endfunction()

sources_of_rooms(core_sources ${FAST_EDI_CORE_ROOMS})
add_library(fast_edi_core ${core_sources})
target_include_directories(fast_edi_core PUBLIC
  $<BUILD_INTERFACE:${FAST_EDI_ROOT}/include>
  $<INSTALL_INTERFACE:${CATKIN_GLOBAL_INCLUDE_DESTINATION}>)
target_include_directories(fast_edi_core PRIVATE ${FAST_EDI_ROOT}/src)
target_compile_features(fast_edi_core PUBLIC cxx_std_17)
target_link_libraries(fast_edi_core PUBLIC Eigen3::Eigen)
# Minima and maxima keep loops from being vectorised as long as their comparisons may have to raise
# floating-point exceptions, which nothing here looks at. Results are the same.
file(GLOB pixel_sources CONFIGURE_DEPENDS ${FAST_EDI_ROOT}/src/filters/*.cpp ${FAST_EDI_ROOT}/src/latent/*.cpp ${FAST_EDI_ROOT}/src/reblur/*.cpp)
set_source_files_properties(${pixel_sources} PROPERTIES COMPILE_OPTIONS -fno-trapping-math)
