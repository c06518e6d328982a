# cmake -B build --toolchain cmake/aarch64-linux-gnu.cmake: for 64-bit ARM Linux by Debian's cross compilers
# (apt install g++-aarch64-linux-gnu) and Rust's library for it (rustup target add aarch64-unknown-linux-gnu).
set(CMAKE_SYSTEM_NAME Linux)
set(CMAKE_SYSTEM_PROCESSOR aarch64)
set(CMAKE_C_COMPILER aarch64-linux-gnu-gcc)
set(CMAKE_CXX_COMPILER aarch64-linux-gnu-g++)
set(MOZZI_CARGO_TARGET aarch64-unknown-linux-gnu CACHE STRING "Rust's name of the target")
set(CMAKE_FIND_ROOT_PATH_MODE_PROGRAM NEVER)
