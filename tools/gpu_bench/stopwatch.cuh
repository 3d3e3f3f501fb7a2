#pragma once

#include <weave/sim/device/device_queue.cuh>

#include <algorithm>
#include <vector>

namespace weave::gpu_bench {

/// Measures by the device's own clock how long what is asked of a queue takes it.
class Stopwatch {
  public:
    explicit Stopwatch(const sim::DeviceQueue& queue) : m_queue(&queue) {
        queue.use();
        WEAVE_CUDA_CHECK(cudaEventCreate(&m_start));
        WEAVE_CUDA_CHECK(cudaEventCreate(&m_stop));
    }
    Stopwatch(const Stopwatch&) = delete;
    Stopwatch& operator=(const Stopwatch&) = delete;
    ~Stopwatch() {
        static_cast<void>(cudaEventDestroy(m_start));
        static_cast<void>(cudaEventDestroy(m_stop));
    }

    /// The median of `times` runs of work(), ms, after one that does not count.
    template <class Work>
    double median_ms(int times, const Work& work) const {
        work();
        std::vector<double> all;
        for (int k = 0; k < times; ++k) {
            WEAVE_CUDA_CHECK(cudaEventRecord(m_start, m_queue->stream()));
            work();
            WEAVE_CUDA_CHECK(cudaEventRecord(m_stop, m_queue->stream()));
            WEAVE_CUDA_CHECK(cudaEventSynchronize(m_stop));
            float ms = 0;
            WEAVE_CUDA_CHECK(cudaEventElapsedTime(&ms, m_start, m_stop));
            all.push_back(static_cast<double>(ms));
        }
        std::nth_element(all.begin(), all.begin() + times / 2, all.end());
        return all[static_cast<std::size_t>(times / 2)];
    }

  private:
    const sim::DeviceQueue* m_queue;
    cudaEvent_t m_start = nullptr, m_stop = nullptr;
};

}  // namespace weave::gpu_bench
