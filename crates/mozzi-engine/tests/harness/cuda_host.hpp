// The parts of CUDA that emitted texts use, on the host: a warp's threads are threads of the system.

#include <barrier>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <thread>
#include <vector>
#define __constant__ static const
#define __shared__ static
#define __launch_bounds__(threads)
#define __syncwarp() warp.arrive_and_wait()
#define __device__
#define __global__
#define __forceinline__ inline
struct Index { unsigned x; };
static const Index blockDim = {32};
static Index gridDim;
static thread_local Index blockIdx, threadIdx;
static std::barrier<> warp(32);
[[maybe_unused]] static long long __double_as_longlong(double x) { long long y; memcpy(&y, &x, 8); return y; }
[[maybe_unused]] static double __longlong_as_double(long long x) { double y; memcpy(&y, &x, 8); return y; }
[[maybe_unused]] static unsigned __float_as_uint(float x) { unsigned y; memcpy(&y, &x, 4); return y; }
[[maybe_unused]] static float __fdividef(float x, float y) { return x / y; }
[[maybe_unused]] static float __uint_as_float(unsigned x) { float y; memcpy(&y, &x, 4); return y; }
// `states` of each thread, at most; without them one block more than needed, so that some threads have no state
template <class Kernel> static void launch(Kernel kernel, unsigned long long count, unsigned states = 1) {
    std::vector<std::thread> threads;
    gridDim.x = states > 1 ? (count + states * blockDim.x - 1) / (states * blockDim.x) : count / blockDim.x + 2;
    for (unsigned t = 0; t < blockDim.x; t++)
        threads.emplace_back([=] {
            threadIdx.x = t;
            for (blockIdx.x = 0; blockIdx.x < gridDim.x; blockIdx.x++) {
                kernel();
                warp.arrive_and_wait(); // the next block has the same shared memory
            }
        });
    for (std::thread &thread : threads) thread.join();
}
