#pragma once

// The crew that the processor drives (crew.hpp): every member is a launch or two, and the processor decides the way on. For cloth
// that is large enough to keep a device busy between two launches. Bodies, terms and tasks are small named functors, copied to the
// device. Sums are formed in an order that depends on their length alone, so they are the same for every run and every device.

#include <weave/sim/device/cuda_gang.cuh>

#include <cstddef>
#include <cstdint>
#include <type_traits>

namespace weave::sim {

/// Threads of a block: that runs a body, that forms a part of a sum, that works alone.
inline constexpr int each_threads = 128, part_threads = 256, alone_threads = 1024;
/// Blocks that form parts of a sum, at most.
inline constexpr std::size_t most_parts = 1024;

struct JoinBySum {
    WEAVE_HD double operator()(double a, double b) const { return a + b; }
};
struct JoinByGreatest {
    WEAVE_HD double operator()(double a, double b) const { return a > b ? a : b; }
};
struct JoinByLeast {
    WEAVE_HD double operator()(double a, double b) const { return a < b ? a : b; }
};

/// The numbers of a block's threads joined in the order of a tree, for its first thread.
template <int threads, class Join>
__device__ double join_block(double mine, const Join& join) {
    __shared__ double numbers[threads];
    numbers[threadIdx.x] = mine;
    for (unsigned width = threads / 2; width > 0; width /= 2) {
        __syncthreads();
        if (threadIdx.x < width) numbers[threadIdx.x] = join(numbers[threadIdx.x], numbers[threadIdx.x + width]);
    }
    return numbers[0];
}

template <class Body>
__global__ void __launch_bounds__(each_threads, 1) each_kernel(const __grid_constant__ Body body, std::size_t count) {
    const std::size_t i = std::size_t{blockIdx.x} * each_threads + threadIdx.x;
    if (i < count) body(i);
}

/// parts[block] = what the block's share of the terms joins to.
template <class Term, class Join>
__global__ void __launch_bounds__(part_threads, 1)
    part_kernel(const __grid_constant__ Term term, std::size_t count, double start, Join join, View<double> parts) {
    double mine = start;
    for (std::size_t i = std::size_t{blockIdx.x} * part_threads + threadIdx.x; i < count; i += std::size_t{gridDim.x} * part_threads)
        mine = join(mine, static_cast<double>(term(i)));
    const double part = join_block<part_threads>(mine, join);
    if (threadIdx.x == 0) parts[blockIdx.x] = part;
}

/// The same of several sums at once: sum k in the blocks of row k.
template <class Term>
__global__ void __launch_bounds__(part_threads, 1) sums_kernel(const __grid_constant__ Term term, std::size_t count, View<double> parts) {
    const std::size_t k = blockIdx.y;
    double mine = 0;
    for (std::size_t i = std::size_t{blockIdx.x} * part_threads + threadIdx.x; i < count; i += std::size_t{gridDim.x} * part_threads)
        mine += static_cast<double>(term(k, i));
    const double part = join_block<part_threads>(mine, JoinBySum{});
    if (threadIdx.x == 0) parts[k * gridDim.x + blockIdx.x] = part;
}

template <class Body>
__global__ void alone_kernel(const __grid_constant__ Body body) {
    body();
}

template <class Task>
__global__ void __launch_bounds__(alone_threads, 1) one_block_kernel(const __grid_constant__ Task task, View<double> parts) {
    CudaBlockGang gang({}, parts);
    task(gang);
}

class Launches {
  public:
    explicit Launches(DeviceQueue& queue);
    Launches(const Launches&) = delete; // its arrays know its memory
    Launches& operator=(const Launches&) = delete;

    // What a crew does is called by templates that nvcc compiles for the device too, where it does nothing; hence the pragmas.

#pragma nv_exec_check_disable
    template <class Body>
    WEAVE_HD void each(std::size_t count, const Body& body) {
        launch_each(count, body);
    }
#pragma nv_exec_check_disable
    template <class Term>
    WEAVE_HD double sum(std::size_t count, const Term& term) {
        return joined(count, term, 0, JoinBySum{});
    }
#pragma nv_exec_check_disable
    template <class Term>
    WEAVE_HD double greatest(std::size_t count, const Term& term) {
        return joined(count, term, 0, JoinByGreatest{});
    }
#pragma nv_exec_check_disable
    template <class Term>
    WEAVE_HD double least(std::size_t count, const Term& term, double start) {
        return joined(count, term, start, JoinByLeast{});
    }
#pragma nv_exec_check_disable
    template <class Term>
    WEAVE_HD void sums(const View<double>& out, std::size_t sums, std::size_t count, const Term& term) {
        launch_sums(out, sums, count, term);
    }
#pragma nv_exec_check_disable
    template <class Count> // a template because the pragma asks for one
    WEAVE_HD std::size_t scan(const View<Count>& counts, std::size_t count) {
        return launch_scan(counts, count);
    }
#pragma nv_exec_check_disable
    template <class T>
    WEAVE_HD std::remove_const_t<T> read(const View<T>& view, std::size_t index) {
        return fetch<std::remove_const_t<T>>(view, index);
    }
#pragma nv_exec_check_disable
    template <class Body>
    WEAVE_HD void alone(const Body& body) {
        launch_alone(body);
    }
#pragma nv_exec_check_disable
    template <class Task>
    WEAVE_HD void in_one_block(const Task& task) {
        launch_in_one_block(task);
    }

  private:
    /// Blocks among which `count` terms are shared out.
    static std::size_t parts_for(std::size_t count);

    template <class Body>
    void launch_each(std::size_t count, const Body& body) {
        if (count == 0) return;
        m_queue->use();
        each_kernel<<<blocks_of((count + each_threads - 1) / each_threads), each_threads, 0, m_queue->stream()>>>(body, count);
        WEAVE_CUDA_CHECK(cudaGetLastError());
    }

    template <class Term, class Join>
    double joined(std::size_t count, const Term& term, double start, const Join& join) {
        if (count == 0) return start;
        m_queue->use();
        const std::size_t parts = parts_for(count);
        part_kernel<<<blocks_of(parts), part_threads, 0, m_queue->stream()>>>(term, count, start, join, m_parts.view());
        WEAVE_CUDA_CHECK(cudaGetLastError());
        join_parts(parts, start, join);
        m_queue->wait();
        return *m_queue->answer<double>();
    }

    template <class Term>
    void launch_sums(const View<double>& out, std::size_t sums, std::size_t count, const Term& term) {
        if (sums == 0) return;
        m_queue->use();
        const std::size_t parts = parts_for(count);
        sums_kernel<<<dim3(blocks_of(parts), blocks_of(sums)), part_threads, 0, m_queue->stream()>>>(term, count, m_parts.view());
        WEAVE_CUDA_CHECK(cudaGetLastError());
        join_sums(out, sums, parts);
    }

    template <class T>
    T fetch(const View<const T>& view, std::size_t index) {
        static_assert(std::is_trivially_destructible_v<T>);
        m_queue->use();
        WEAVE_CUDA_CHECK(cudaMemcpyAsync(m_queue->answer<T>(), view.at(index, 1), sizeof(T), cudaMemcpyDeviceToHost, m_queue->stream()));
        m_queue->wait();
        return *m_queue->answer<T>();
    }

    template <class Body>
    void launch_alone(const Body& body) {
        m_queue->use();
        alone_kernel<<<1, 1, 0, m_queue->stream()>>>(body);
        WEAVE_CUDA_CHECK(cudaGetLastError());
    }

    template <class Task>
    void launch_in_one_block(const Task& task) {
        m_queue->use();
        one_block_kernel<<<1, alone_threads, alone_threads * sizeof(double), m_queue->stream()>>>(task, m_parts.view());
        WEAVE_CUDA_CHECK(cudaGetLastError());
    }

    std::size_t launch_scan(const View<std::uint32_t>& counts, std::size_t count);

    /// The first `parts` parts joined, as the queue's answer.
    void join_parts(std::size_t parts, double start, JoinBySum join);
    void join_parts(std::size_t parts, double start, JoinByGreatest join);
    void join_parts(std::size_t parts, double start, JoinByLeast join);
    void join_sums(const View<double>& out, std::size_t sums, std::size_t parts);

    /// A number of blocks as a launch takes it; throws std::length_error beyond what a device counts.
    static unsigned blocks_of(std::size_t blocks);

    DeviceQueue* m_queue;
    CudaMemory m_memory;
    Array<double> m_parts;
    Array<unsigned char> m_scan_room;
};

}  // namespace weave::sim
