#pragma once

#include <weave/sim/device/cuda_check.cuh>
#include <weave/sim/device/memory.hpp>

#include <cstddef>
#include <new>
#include <string>

namespace weave::sim {

/// What is asked of one device, done in the order of asking, apart from all other queues. Of one thread at a time.
class DeviceQueue {
  public:
    /// Bytes that the device can answer with at once.
    static constexpr std::size_t answer_bytes = 256;

    explicit DeviceQueue(int device = 0);
    DeviceQueue(const DeviceQueue&) = delete;
    DeviceQueue& operator=(const DeviceQueue&) = delete;
    ~DeviceQueue();

    /// Makes its device the one that the calling thread speaks to.
    void use() const { WEAVE_CUDA_CHECK(cudaSetDevice(m_device)); }
    /// Until all that was asked for is done.
    void wait() const { WEAVE_CUDA_CHECK(cudaStreamSynchronize(m_stream)); }

    [[nodiscard]] int device() const { return m_device; }
    [[nodiscard]] std::size_t multiprocessors() const { return m_multiprocessors; }
    [[nodiscard]] cudaStream_t stream() const { return m_stream; }
    /// Memory of the processor that kernels write to as well; to be read after wait().
    template <class T>
    [[nodiscard]] T* answer() const {
        static_assert(sizeof(T) <= answer_bytes);
        return static_cast<T*>(m_answer);
    }

  private:
    int m_device;
    std::size_t m_multiprocessors = 0;
    cudaStream_t m_stream = nullptr;
    void* m_answer = nullptr;
};

/// Less memory of a device than was asked for.
class DeviceMemoryShort : public std::bad_alloc {
  public:
    DeviceMemoryShort(std::size_t asked, std::size_t free);
    [[nodiscard]] const char* what() const noexcept override { return m_words.c_str(); }

  private:
    std::string m_words;
};

/// The memory of a queue's device; what is put and got waits for its turn in the queue.
class CudaMemory : public Memory {
  public:
    explicit CudaMemory(const DeviceQueue& queue) : m_queue(&queue) {}

    void* take(std::size_t bytes) override;
    void give(void* at) noexcept override;
    void put(void* to, const void* from, std::size_t bytes) override;
    void get(void* to, const void* from, std::size_t bytes) override;

  private:
    const DeviceQueue* m_queue;
};

}  // namespace weave::sim
