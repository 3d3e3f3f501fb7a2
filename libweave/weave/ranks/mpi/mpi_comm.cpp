#include <weave/ranks/mpi/mpi_comm.hpp>

#include <cstdlib>
#include <mpi.h>
#include <numeric>
#include <sched.h>
#include <utility>

namespace weave::ranks {

namespace {

class MpiComm final : public Comm {
  public:
    MpiComm(std::chrono::seconds patience, std::function<void(const std::string&)> tell_lost)
        : m_patience(patience), m_tell_lost(std::move(tell_lost)) {
        int rank = 0, size = 1;
        MPI_Comm_rank(MPI_COMM_WORLD, &rank);
        MPI_Comm_size(MPI_COMM_WORLD, &size);
        m_rank = static_cast<std::size_t>(rank);
        m_size = static_cast<std::size_t>(size);
    }
    ~MpiComm() override { MPI_Finalize(); }

    [[nodiscard]] std::size_t rank() const override { return m_rank; }
    [[nodiscard]] std::size_t size() const override { return m_size; }

    using Comm::gather;
    void gather(std::span<const double> own, std::span<const std::size_t> counts, Packet& all) override {
        std::vector<int> lengths, places;
        int place = 0;
        for (const std::size_t count : counts) {
            lengths.push_back(static_cast<int>(count));
            places.push_back(place);
            place += lengths.back();
        }
        all.resize(static_cast<std::size_t>(place));
        std::vector<MPI_Request> requests(1);
        MPI_Iallgatherv(own.data(), static_cast<int>(own.size()), MPI_DOUBLE, all.data(), lengths.data(), places.data(), MPI_DOUBLE,
                        MPI_COMM_WORLD, requests.data());
        await(requests);
        ++m_traffic.gatherings;
        m_traffic.gathered_bytes += own.size_bytes();
    }

    void exchange(const std::vector<Letter>& out, std::vector<Letter>& in) override {
        std::vector<MPI_Request> requests(out.size() + in.size());
        auto request = requests.begin();
        for (Letter& letter : in)
            MPI_Irecv(letter.numbers.data(), static_cast<int>(letter.numbers.size()), MPI_DOUBLE, static_cast<int>(letter.rank), 0, MPI_COMM_WORLD, &*request++);
        for (const Letter& letter : out) {
            MPI_Isend(letter.numbers.data(), static_cast<int>(letter.numbers.size()), MPI_DOUBLE, static_cast<int>(letter.rank), 0, MPI_COMM_WORLD, &*request++);
            ++m_traffic.messages;
            m_traffic.bytes += 8 * letter.numbers.size();
        }
        await(requests);
    }

  private:
    /// Waits as long as patience lasts. Where there are more ranks than cores, others need this one's to get on.
    void await(std::vector<MPI_Request>& requests) const {
        constexpr int spins = 200;
        const auto end = std::chrono::steady_clock::now() + m_patience;
        for (int turn = 0;; ++turn) {
            int done = 0;
            MPI_Testall(static_cast<int>(requests.size()), requests.data(), &done, MPI_STATUSES_IGNORE);
            if (done != 0) return;
            if (turn < spins) continue;
            ::sched_yield();
            if (turn % spins == 0 && std::chrono::steady_clock::now() > end) give_up();
        }
    }

    [[noreturn]] void give_up() const {
        m_tell_lost("rank " + std::to_string(m_rank) + " of " + std::to_string(m_size) + " has had no answer from the others for " +
                    std::to_string(m_patience.count()) + " s: a process hangs, or the network between them is cut");
        MPI_Abort(MPI_COMM_WORLD, 5);
        std::abort();
    }

    std::chrono::seconds m_patience;
    std::function<void(const std::string&)> m_tell_lost;
    std::size_t m_rank = 0, m_size = 1;
};

}  // namespace

bool is_one_of_many() {
    return std::getenv("OMPI_COMM_WORLD_SIZE") != nullptr;
}

Result<std::unique_ptr<Comm>> join_others(std::chrono::seconds patience, std::function<void(const std::string&)> tell_lost) {
    int given = 0;
    if (MPI_Init_thread(nullptr, nullptr, MPI_THREAD_FUNNELED, &given) != MPI_SUCCESS)
        return system_fault("MPI cannot begin");
    return std::unique_ptr<Comm>(std::make_unique<MpiComm>(patience, std::move(tell_lost)));
}

}  // namespace weave::ranks
