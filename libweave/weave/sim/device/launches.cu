#include <weave/sim/device/launches.cuh>

#include <cub/device/device_scan.cuh>

#include <algorithm>
#include <limits>
#include <stdexcept>

namespace weave::sim {

namespace {

template <class Join>
__global__ void __launch_bounds__(most_parts, 1) join_kernel(View<const double> parts, std::size_t count, double start, Join join, double* out) {
    const double joined = join_block<most_parts>(threadIdx.x < count ? parts[threadIdx.x] : start, join);
    if (threadIdx.x == 0) *out = joined;
}

__global__ void __launch_bounds__(most_parts, 1) join_sums_kernel(View<const double> parts, std::size_t count, View<double> out) {
    const double sum = join_block<most_parts>(threadIdx.x < count ? parts[blockIdx.x * count + threadIdx.x] : 0, JoinBySum{});
    if (threadIdx.x == 0) out[blockIdx.x] = sum;
}

struct CountTerm {
    View<const std::uint32_t> counts;
    WEAVE_HD double operator()(std::size_t i) const { return counts[i]; }
};

template <class Join>
void launch_join(const DeviceQueue& queue, const View<double>& parts, std::size_t count, double start, Join join) {
    join_kernel<<<1, most_parts, 0, queue.stream()>>>(View<const double>(parts), count, start, join, queue.answer<double>());
    WEAVE_CUDA_CHECK(cudaGetLastError());
}

}  // namespace

Launches::Launches(DeviceQueue& queue)
    : m_queue(&queue), m_memory(queue), m_parts(m_memory, std::max(most_sums * most_parts, parts_of_gang(1))), m_scan_room(m_memory) {}

std::size_t Launches::parts_for(std::size_t count) {
    return std::clamp<std::size_t>((count + part_threads - 1) / part_threads, 1, most_parts);
}

unsigned Launches::blocks_of(std::size_t blocks) {
    if (blocks > static_cast<std::size_t>(std::numeric_limits<int>::max())) throw std::length_error("more blocks than a device counts");
    return static_cast<unsigned>(blocks);
}

void Launches::join_parts(std::size_t parts, double start, JoinBySum join) {
    launch_join(*m_queue, m_parts.view(), parts, start, join);
}

void Launches::join_parts(std::size_t parts, double start, JoinByGreatest join) {
    launch_join(*m_queue, m_parts.view(), parts, start, join);
}

void Launches::join_parts(std::size_t parts, double start, JoinByLeast join) {
    launch_join(*m_queue, m_parts.view(), parts, start, join);
}

void Launches::join_sums(const View<double>& out, std::size_t sums, std::size_t parts) {
    join_sums_kernel<<<blocks_of(sums), most_parts, 0, m_queue->stream()>>>(View<const double>(m_parts.view()), parts, out);
    WEAVE_CUDA_CHECK(cudaGetLastError());
}

std::size_t Launches::launch_scan(const View<std::uint32_t>& counts, std::size_t count) {
    if (count == 0) return 0;
    if (count > static_cast<std::size_t>(std::numeric_limits<int>::max())) throw std::length_error("more counts than a scan takes");
    const double all = joined(count, CountTerm{counts}, 0, JoinBySum{}); // exact up to 2^53
    std::uint32_t* at = counts.at(0, count);
    std::size_t room = 0;
    WEAVE_CUDA_CHECK(cub::DeviceScan::ExclusiveSum(nullptr, room, at, at, static_cast<int>(count), m_queue->stream()));
    if (m_scan_room.size() < room) {
        m_queue->wait(); // what there is may be in use
        m_scan_room.resize(room);
    }
    WEAVE_CUDA_CHECK(cub::DeviceScan::ExclusiveSum(m_scan_room.view().at(0, room), room, at, at, static_cast<int>(count), m_queue->stream()));
    return static_cast<std::size_t>(all);
}

}  // namespace weave::sim
