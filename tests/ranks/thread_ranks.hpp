#pragma once

#include <weave/ranks/comm.hpp>

#include <algorithm>
#include <barrier>
#include <exception>
#include <functional>
#include <thread>
#include <vector>

namespace weave::ranks::testing {

/// What threads share that stand for ranks.
struct Meeting {
    explicit Meeting(std::size_t ranks) : all(static_cast<std::ptrdiff_t>(ranks)), told(ranks), letters(ranks, std::vector<Comm::Packet>(ranks)) {}
    std::barrier<> all;
    std::vector<Comm::Packet> told;
    std::vector<std::vector<Comm::Packet>> letters;  ///< from, to
};

/// One of several threads as a rank.
class ThreadComm final : public Comm {
  public:
    ThreadComm(Meeting& meeting, std::size_t rank) : m_meeting(meeting), m_rank(rank) {}
    [[nodiscard]] std::size_t rank() const override { return m_rank; }
    [[nodiscard]] std::size_t size() const override { return m_meeting.told.size(); }
    using Comm::gather;
    void gather(std::span<const double> own, std::span<const std::size_t> counts, Packet& all) override {
        Packet mine(own.begin(), own.end());
        if (mine.size() != counts[m_rank]) std::terminate();  // what MPI would take for a truncated message
        m_meeting.told[m_rank] = std::move(mine);
        m_meeting.all.arrive_and_wait();
        all.clear();
        for (const Packet& packet : m_meeting.told) all.insert(all.end(), packet.begin(), packet.end());
        m_meeting.all.arrive_and_wait();
    }
    void exchange(const std::vector<Letter>& out, std::vector<Letter>& in) override {
        for (const Letter& letter : out) m_meeting.letters[m_rank][letter.rank] = letter.numbers;
        m_meeting.all.arrive_and_wait();
        for (Letter& letter : in) {
            if (letter.numbers.size() != m_meeting.letters[letter.rank][m_rank].size()) std::terminate();
            letter.numbers = std::move(m_meeting.letters[letter.rank][m_rank]);
        }
        m_meeting.all.arrive_and_wait();
    }

  private:
    Meeting& m_meeting;
    std::size_t m_rank;
};

/// work(comm) by so many ranks at once.
inline void by_ranks(std::size_t ranks, const std::function<void(Comm&)>& work) {
    Meeting meeting(ranks);
    std::vector<std::thread> threads;
    for (std::size_t rank = 0; rank < ranks; ++rank) {
        threads.emplace_back([&, rank] {
            ThreadComm comm(meeting, rank);
            work(comm);
        });
    }
    for (std::thread& thread : threads) thread.join();
}

}  // namespace weave::ranks::testing
