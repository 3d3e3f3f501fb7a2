#pragma once

// Gangs of a device's threads (crew.hpp): one kernel that stays there from the first step to the last, whose blocks wait for one
// another by cooperative launch.

#include <weave/sim/device/crew.hpp>
#include <weave/sim/device/device_queue.cuh>

#include <cooperative_groups.h>

#include <algorithm>
#include <cstddef>

namespace weave::sim {

/// Threads of a block in a gang, where nothing else is said.
inline constexpr int gang_threads = 256;

/// A thread of a kernel, as Gang wants it. On the processor it is nobody: templates are compiled for both.
struct CudaThread {
#if defined(__CUDA_ARCH__)
    WEAVE_HD std::size_t thread() const { return threadIdx.x; }
    WEAVE_HD std::size_t threads() const { return blockDim.x; }
    WEAVE_HD std::size_t block() const { return blockIdx.x; }
    WEAVE_HD std::size_t blocks() const { return gridDim.x; }
    WEAVE_HD void sync_block() const { __syncthreads(); }
    WEAVE_HD void sync_all() const { cooperative_groups::this_grid().sync(); }
    WEAVE_HD double* shared() const {
        extern __shared__ double shared_numbers[];
        return shared_numbers;
    }
#else
    WEAVE_HD std::size_t thread() const { return 0; }
    WEAVE_HD std::size_t threads() const { return 1; }
    WEAVE_HD std::size_t block() const { return 0; }
    WEAVE_HD std::size_t blocks() const { return 1; }
    WEAVE_HD void sync_block() const {}
    WEAVE_HD void sync_all() const {}
    WEAVE_HD double* shared() const { return nullptr; }
#endif
};

/// A gang of all blocks, and one of a block alone.
using CudaGang = Gang<CudaThread>;
using CudaBlockGang = Gang<BlockOf<CudaThread>>;

// Every kernel's launch bounds say that one block on a multiprocessor is enough. Without that nvcc 13.0 wants as many as the
// threads of a multiprocessor make, and spills registers for it (256 threads: 32 registers and spills where 40 were enough).

/// kernel(gang) by all blocks together.
template <int threads, class Kernel>
__global__ void __launch_bounds__(threads, 1) gang_kernel(const __grid_constant__ Kernel kernel, View<double> parts) {
    CudaGang gang({}, parts);
    kernel(gang);
}

/// kernel(gang, block) by each block for itself.
template <int threads, class Kernel>
__global__ void __launch_bounds__(threads, 1) block_gangs_kernel(const __grid_constant__ Kernel kernel, View<double> parts) {
    constexpr std::size_t own = parts_of_gang(1);
    CudaBlockGang gang({}, parts.slice(own * blockIdx.x, own));
    kernel(gang, std::size_t{blockIdx.x});
}

/// Runs kernels as gangs on a queue's device. A kernel is a small named functor of views and numbers, copied to the device.
class GangRunner {
  public:
    explicit GangRunner(DeviceQueue& queue) : m_queue(&queue), m_memory(queue), m_parts(m_memory) {}
    GangRunner(const GangRunner&) = delete; // its arrays know its memory
    GangRunner& operator=(const GangRunner&) = delete;

    /// Blocks that the device holds at once, so that they can wait for one another.
    template <int threads = gang_threads, class Kernel>
    [[nodiscard]] std::size_t most_blocks(const Kernel&) const {
        m_queue->use();
        int blocks = 0;
        WEAVE_CUDA_CHECK(cudaOccupancyMaxActiveBlocksPerMultiprocessor(&blocks, gang_kernel<threads, Kernel>, threads, shared_bytes(threads)));
        return static_cast<std::size_t>(blocks) * m_queue->multiprocessors();
    }

    /// kernel(gang) by so many blocks, as many as there is room for at most; 0: by that many. Returns when all is done.
    template <int threads = gang_threads, class Kernel>
    void run(const Kernel& kernel, std::size_t blocks = 0) {
        start<threads>(kernel, blocks);
        m_queue->wait();
    }

    /// The same without waiting. What `kernel` refers to must stay until the queue has been waited for.
    template <int threads = gang_threads, class Kernel>
    void start(const Kernel& kernel, std::size_t blocks = 0) {
        const std::size_t most = most_blocks<threads>(kernel);
        blocks = blocks == 0 ? most : std::min(blocks, most);
        ask_for(parts_of_gang(blocks));
        const dim3 grid(static_cast<unsigned>(blocks)), block(threads);
        const View<double> parts = m_parts.view();
        Kernel copy = kernel;
        void* arguments[]{&copy, const_cast<View<double>*>(&parts)};
        WEAVE_CUDA_CHECK(cudaLaunchCooperativeKernel(gang_kernel<threads, Kernel>, grid, block, arguments, shared_bytes(threads), m_queue->stream()));
    }

    /// kernel(gang, k) for every k below `gangs`, each by a block for itself, any number of them at once: small cells next to one
    /// another. Returns when all is done.
    template <int threads = gang_threads, class Kernel>
    void run_each(const Kernel& kernel, std::size_t gangs) {
        if (gangs == 0) return;
        m_queue->use();
        ask_for(parts_of_gang(1) * gangs);
        const auto blocks = static_cast<unsigned>(gangs);
        block_gangs_kernel<threads, Kernel><<<blocks, threads, shared_bytes(threads), m_queue->stream()>>>(kernel, m_parts.view());
        WEAVE_CUDA_CHECK(cudaGetLastError());
        m_queue->wait();
    }

  private:
    static constexpr std::size_t shared_bytes(int threads) { return static_cast<std::size_t>(threads) * sizeof(double); }

    void ask_for(std::size_t parts) {
        if (m_parts.size() >= parts) return;
        m_queue->wait(); // those there are may be in use
        m_parts.resize(parts);
    }

    DeviceQueue* m_queue;
    CudaMemory m_memory;
    Array<double> m_parts;
};

}  // namespace weave::sim
