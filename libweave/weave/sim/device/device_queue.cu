#include <weave/sim/device/device_queue.cuh>

#include <weave/sim/device/devices.hpp>

namespace weave::sim {

DeviceQueue::DeviceQueue(int device) : m_device(device) {
    use();
    int count = 0;
    WEAVE_CUDA_CHECK(cudaDeviceGetAttribute(&count, cudaDevAttrMultiProcessorCount, device));
    m_multiprocessors = static_cast<std::size_t>(count);
    WEAVE_CUDA_CHECK(cudaStreamCreateWithFlags(&m_stream, cudaStreamNonBlocking));
    const cudaError_t pinned = cudaMallocHost(&m_answer, answer_bytes);
    if (pinned != cudaSuccess) static_cast<void>(cudaStreamDestroy(m_stream)); // no destructor runs for what is half made
    WEAVE_CUDA_CHECK(pinned);
}

DeviceQueue::~DeviceQueue() {
    static_cast<void>(cudaStreamSynchronize(m_stream)); // what fails here has been told, or nobody asked
    static_cast<void>(cudaFreeHost(m_answer));
    static_cast<void>(cudaStreamDestroy(m_stream));
    static_cast<void>(cudaGetLastError());
}

DeviceMemoryShort::DeviceMemoryShort(std::size_t asked, std::size_t free)
    : m_words("the device has " + std::to_string(free) + " bytes left, and " + std::to_string(asked) + " were asked for") {}

void* CudaMemory::take(std::size_t bytes) {
    m_queue->use();
    void* at = nullptr;
    const cudaError_t taken = cudaMalloc(&at, bytes);
    if (taken == cudaErrorMemoryAllocation) {
        static_cast<void>(cudaGetLastError());
        std::size_t free = 0, all = 0;
        WEAVE_CUDA_CHECK(cudaMemGetInfo(&free, &all));
        throw DeviceMemoryShort(bytes, free);
    }
    WEAVE_CUDA_CHECK(taken);
    const cudaError_t cleared = cudaMemsetAsync(at, 0, bytes, m_queue->stream());
    if (cleared != cudaSuccess) give(at);
    WEAVE_CUDA_CHECK(cleared);
    return at;
}

void CudaMemory::give(void* at) noexcept {
    static_cast<void>(cudaFree(at)); // waits for the device; what had failed before is told elsewhere
    static_cast<void>(cudaGetLastError());
}

void CudaMemory::put(void* to, const void* from, std::size_t bytes) {
    m_queue->use();
    WEAVE_CUDA_CHECK(cudaMemcpyAsync(to, from, bytes, cudaMemcpyHostToDevice, m_queue->stream()));
    m_queue->wait();
}

void CudaMemory::get(void* to, const void* from, std::size_t bytes) {
    m_queue->use();
    WEAVE_CUDA_CHECK(cudaMemcpyAsync(to, from, bytes, cudaMemcpyDeviceToHost, m_queue->stream()));
    m_queue->wait();
}

}  // namespace weave::sim
