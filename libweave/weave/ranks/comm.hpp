#pragma once

#include <weave/core/result.hpp>

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace weave::ranks {

/// The processes that relax one cloth together, each with its rank, and what they tell one another. All ranks make the same
/// calls in the same order. Nothing here adds numbers up: what is told comes in the order of ranks, and whoever adds does so
/// in an order that does not depend on how many ranks there are.
class Comm {
  public:
    using Packet = std::vector<double>;
    /// Numbers for another rank, or room for what comes from it.
    struct Letter {
        std::size_t rank = 0;
        Packet numbers;
    };
    /// What this rank has sent since the start, and how often all ranks had to wait for one another.
    struct Traffic {
        std::uint64_t messages = 0, bytes = 0;             ///< from this rank to single others
        std::uint64_t gatherings = 0, gathered_bytes = 0;  ///< told to all, and how much of this rank's
    };

    Comm() = default;
    Comm(const Comm&) = delete;
    Comm& operator=(const Comm&) = delete;
    virtual ~Comm() = default;

    [[nodiscard]] virtual std::size_t rank() const = 0;
    [[nodiscard]] virtual std::size_t size() const = 0;
    [[nodiscard]] bool is_first() const { return rank() == 0; }

    /// The numbers of all ranks one after another. `counts`: how many each has, the same on all ranks.
    virtual void gather(std::span<const double> own, std::span<const std::size_t> counts, Packet& all) = 0;

    /// Sends letters and fills the others; both sides know how long each is, none is from a rank to itself.
    virtual void exchange(const std::vector<Letter>& out, std::vector<Letter>& in) = 0;

    /// One packet to each rank, of any length, and one from each; for what happens seldom.
    std::vector<Packet> swap(std::vector<Packet> to_each);
    /// The packets of all ranks, of any length, in their order.
    std::vector<Packet> gather(const Packet& own);
    /// One number of each rank.
    std::vector<double> gather(double own);

    [[nodiscard]] const Traffic& traffic() const { return m_traffic; }

  protected:
    Traffic m_traffic;
};

/// One process alone.
class SerialComm : public Comm {
  public:
    [[nodiscard]] std::size_t rank() const override { return 0; }
    [[nodiscard]] std::size_t size() const override { return 1; }
    void gather(std::span<const double> own, std::span<const std::size_t>, Packet& all) override { all.assign(own.begin(), own.end()); }
    void exchange(const std::vector<Letter>&, std::vector<Letter>&) override {}
    using Comm::gather;
};

/// The error of the first rank that has one, on all of them, with that rank's number where it is not the first; all call it at once.
/// So all end alike, and whoever tells it tells the cause.
Status agreed(Comm& comm, const Status& own);

}  // namespace weave::ranks
