#include <weave/ranks/exchange.hpp>

#include <algorithm>
#include <tuple>

namespace weave::ranks {

namespace {

/// Where a point lies among those of a rank's blocks, which follow one another from block `first` on.
class Directory {
  public:
    Directory(const std::vector<Part>& parts, std::size_t first) : m_parts(parts), m_first(first), m_begin{0} {
        for (const Part& part : parts) m_begin.push_back(m_begin.back() + part.own.size());
    }
    [[nodiscard]] std::uint32_t find(std::size_t block, std::uint32_t yarn, std::uint32_t index) const {
        const std::vector<Point>& own = m_parts[block - m_first].own;
        const auto at = std::lower_bound(own.begin(), own.end(), std::pair(yarn, index), [](const Point& point, const auto& wanted) {
            return std::pair(point.yarn, point.index) < wanted;
        });
        return static_cast<std::uint32_t>(m_begin[block - m_first] + static_cast<std::size_t>(at - own.begin()));
    }

  private:
    const std::vector<Part>& m_parts;
    std::size_t m_first;
    std::vector<std::size_t> m_begin;
};

void copy_three(const std::vector<double>& from, std::size_t at, std::vector<double>& to, std::size_t place) {
    for (std::size_t k = 0; k < 3; ++k) to[3 * place + k] = from[3 * at + k];
}

}  // namespace

Exchange::Exchange(Comm& comm, const Cut& cut, const std::vector<Part>& parts, const std::vector<std::vector<Met>>& guests) : m_comm(&comm) {
    std::vector<Comm::Packet> wishes(comm.size());
    std::vector<std::vector<std::uint32_t>> places(comm.size());
    for (const std::vector<Met>& of_block : guests) {
        for (const Met& guest : of_block) {
            const std::size_t rank = cut.rank_of(guest.point.block, comm.size());
            for (const std::uint32_t part : {guest.point.block, guest.point.yarn, guest.point.index}) wishes[rank].push_back(part);
            places[rank].push_back(static_cast<std::uint32_t>(m_guests++));
        }
    }
    const std::vector<Comm::Packet> wished = comm.swap(std::move(wishes));
    const Directory directory(parts, cut.blocks_of(comm.rank(), comm.size())[0]);
    for (std::size_t rank = 0; rank < comm.size(); ++rank) {
        std::vector<std::uint32_t> points;
        const auto part = [&](std::size_t k) { return static_cast<std::uint32_t>(wished[rank][k]); };
        for (std::size_t k = 0; k < wished[rank].size(); k += 3) points.push_back(directory.find(part(k), part(k + 1), part(k + 2)));
        if (rank == comm.rank()) {
            m_near_points = std::move(points);
            m_near_places = std::move(places[rank]);
            continue;
        }
        if (!points.empty()) {
            m_out.push_back({rank, Comm::Packet(3 * points.size())});
            m_points.push_back(std::move(points));
        }
        if (!places[rank].empty()) {
            m_in.push_back({rank, Comm::Packet(3 * places[rank].size())});
            m_places.push_back(std::move(places[rank]));
        }
    }
}

void Exchange::run(const std::vector<double>& own, std::vector<double>& guests) {
    guests.resize(3 * m_guests);
    for (std::size_t l = 0; l < m_out.size(); ++l) {
        for (std::size_t k = 0; k < m_points[l].size(); ++k) copy_three(own, m_points[l][k], m_out[l].numbers, k);
    }
    m_comm->exchange(m_out, m_in);
    for (std::size_t l = 0; l < m_in.size(); ++l) {
        for (std::size_t k = 0; k < m_places[l].size(); ++k) copy_three(m_in[l].numbers, k, guests, m_places[l][k]);
    }
    for (std::size_t k = 0; k < m_near_points.size(); ++k) copy_three(own, m_near_points[k], guests, m_near_places[k]);
}

}  // namespace weave::ranks
