#pragma once

#include <weave/ranks/comm.hpp>
#include <weave/ranks/cut.hpp>

#include <cstddef>
#include <cstdint>
#include <vector>

namespace weave::ranks {

/// Brings the numbers of points from the blocks that they belong to to those where they are guests: one letter between each two
/// ranks that have to do with one another.
class Exchange {
  public:
    Exchange() = default;
    /// `guests` of each block of this rank, block after block; `parts` are its blocks. Called by all ranks at once.
    Exchange(Comm& comm, const Cut& cut, const std::vector<Part>& parts, const std::vector<std::vector<Met>>& guests);

    /// `own`: three numbers for each point of this rank's blocks, block after block; `guests` is filled alike.
    void run(const std::vector<double>& own, std::vector<double>& guests);

    [[nodiscard]] std::size_t guests() const { return m_guests; }

  private:
    Comm* m_comm = nullptr;
    std::size_t m_guests = 0;
    /// Of each letter: which points it brings, of those that are sent, and which guests, of those that come.
    std::vector<std::vector<std::uint32_t>> m_points, m_places;
    std::vector<std::uint32_t> m_near_points, m_near_places;  ///< on this rank itself
    std::vector<Comm::Letter> m_out, m_in;
};

}  // namespace weave::ranks
