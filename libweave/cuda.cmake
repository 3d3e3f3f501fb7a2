# Code for CUDA devices, where nvcc is found. Leaves WEAVE_HAS_CUDA, and weave_cuda_options for what compiles .cu files.
option(WEAVE_CUDA "Build code for CUDA devices where nvcc is found" ON)
set(WEAVE_HAS_CUDA OFF)
if(NOT WEAVE_CUDA OR WEAVE_SANITIZE OR WEAVE_COVERAGE OR WEAVE_FUZZ) # which ask about what runs on the processor
  return()
endif()
find_program(WEAVE_NVCC nvcc HINTS ENV CUDA_PATH PATHS /usr/local/cuda PATH_SUFFIXES bin)
if(NOT WEAVE_NVCC)
  message(STATUS "No nvcc: built without code for CUDA devices")
  return()
endif()

set(CMAKE_CUDA_COMPILER ${WEAVE_NVCC})
if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
  set(CMAKE_CUDA_HOST_COMPILER ${CMAKE_CXX_COMPILER})
endif()
if(NOT CMAKE_CUDA_ARCHITECTURES)
  set(CMAKE_CUDA_ARCHITECTURES "80-real;90" CACHE STRING "Devices that code is compiled for; PTX of the last runs on later ones")
endif()
set(CMAKE_CUDA_RUNTIME_LIBRARY Static)
enable_language(CUDA)
find_package(CUDAToolkit REQUIRED)
# CMake 3.25 does not know nvcc's option for C++20.
set(CMAKE_CUDA20_STANDARD_COMPILE_OPTION "-std=c++20")
set(CMAKE_CUDA20_EXTENSION_COMPILE_OPTION "-std=c++20")
if(NOT "cuda_std_20" IN_LIST CMAKE_CUDA_COMPILE_FEATURES)
  list(APPEND CMAKE_CUDA_COMPILE_FEATURES cuda_std_20)
endif()
set(CMAKE_CUDA_STANDARD 20)
set(CMAKE_CUDA_STANDARD_REQUIRED ON)
set(CMAKE_CUDA_EXTENSIONS OFF)
set(CMAKE_CUDA_COMPILER_LAUNCHER ${CMAKE_CURRENT_LIST_DIR}/nvcc_logged ${WEAVE_CCACHE})
set(WEAVE_HAS_CUDA ON)

# A call from device code into host code comes out as an empty kernel or a trap and is a warning only, none at all inside system
# headers: so it is an error here, and Eigen's headers count as our own (weave_device_sources). PTX stays readable, for
# tests/checks/kernels.
add_library(weave_cuda_options INTERFACE)
target_compile_options(weave_cuda_options INTERFACE $<$<COMPILE_LANGUAGE:CUDA>:--expt-relaxed-constexpr -diag-suppress=20012
  -Werror=cross-execution-space-call -Xptxas=-v --no-compress -Xcompiler=-Wall,-Wextra,-Wshadow,-Wno-unknown-pragmas>)
if(WEAVE_WARNINGS_ARE_ERRORS)
  target_compile_options(weave_cuda_options INTERFACE $<$<COMPILE_LANGUAGE:CUDA>:-Xcompiler=-Werror>)
endif()

# Says how a target's .cu files are compiled, and that it is linked as C++.
function(weave_compiles_cuda target)
  target_link_libraries(${target} PRIVATE weave_cuda_options weave_options)
  set_target_properties(${target} PROPERTIES NO_SYSTEM_FROM_IMPORTED ON LINKER_LANGUAGE CXX)
endfunction()
