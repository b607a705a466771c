# Compiler options, dependencies and the Python interpreter, in one place.

find_package(Eigen3 3.4 REQUIRED NO_MODULE)
find_package(fmt 9 REQUIRED)
find_package(tomlplusplus REQUIRED)
find_package(CLI11 2 REQUIRED)
find_package(nlohmann_json 3 REQUIRED)
find_package(OpenMP REQUIRED COMPONENTS CXX)
find_package(HDF5 REQUIRED COMPONENTS C)

add_library(plumb_options INTERFACE)
target_compile_features(plumb_options INTERFACE cxx_std_20)
target_include_directories(plumb_options INTERFACE $<BUILD_INTERFACE:${CMAKE_SOURCE_DIR}/solver>)
target_include_directories(plumb_options SYSTEM INTERFACE ${HDF5_INCLUDE_DIRS})
target_link_libraries(plumb_options INTERFACE Eigen3::Eigen fmt::fmt tomlplusplus::tomlplusplus CLI11::CLI11
                                              nlohmann_json::nlohmann_json OpenMP::OpenMP_CXX ${HDF5_LIBRARIES})

set(PLUMB_WARNINGS -Wall -Wextra -Wshadow -Wconversion -Werror)
# Packs of eight doubles never cross a library boundary, so their calling convention does not matter.
list(APPEND PLUMB_WARNINGS -Wno-psabi)
if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
  list(APPEND PLUMB_WARNINGS -Wno-stringop-overflow) # false alarm of g++ 12 inside fmt 9 at -O3
endif()
target_compile_options(plumb_options INTERFACE ${PLUMB_WARNINGS})

# errno after sqrt is never read; every other rule of IEEE arithmetic stays in force.
target_compile_options(plumb_options INTERFACE -fno-math-errno)
if(PLUMB_PORTABLE)
  target_compile_options(plumb_options INTERFACE -ffp-contract=off)
else()
  target_compile_options(plumb_options INTERFACE -march=native)
endif()
if(PLUMB_SANITIZE)
  target_compile_options(plumb_options INTERFACE -fsanitize=address,undefined -fno-sanitize-recover=all
                                                 -fno-omit-frame-pointer -UNDEBUG)
  target_link_options(plumb_options INTERFACE -fsanitize=address,undefined)
endif()
if(PLUMB_ASSERT)
  target_compile_options(plumb_options INTERFACE -UNDEBUG)
endif()
set(CMAKE_CXX_FLAGS_RELEASE "-O3 -DNDEBUG")

# Another python3 may come first in PATH; take the first one that has what the judge needs.
if(NOT PLUMB_PYTHON)
  execute_process(COMMAND ${CMAKE_SOURCE_DIR}/ci/find_python OUTPUT_VARIABLE found OUTPUT_STRIP_TRAILING_WHITESPACE
                  RESULT_VARIABLE failed)
  if(failed)
    message(FATAL_ERROR "No python3 with numpy, scipy, matplotlib, h5py and jinja2 found; ci/install_dependencies installs them")
  endif()
  set(PLUMB_PYTHON ${found} CACHE FILEPATH "python3 for the judge" FORCE)
endif()
