#pragma once

#include <weave/wire/mill_client.hpp>
#include <weave/wire/mill_session.hpp>

#include <atomic>
#include <condition_variable>
#include <deque>
#include <filesystem>
#include <functional>
#include <mutex>
#include <optional>
#include <thread>

namespace weave::studio {

/// The studio's line to a mill: a thread in which one call after another is made, as the person of the kept
/// session.
class MillLine {
  public:
    /// Runs in the thread. An error ends it; one that says that nobody is signed in makes the line look for a
    /// newer kept session and try once more.
    using Errand = std::function<Status(MillLine&)>;

    explicit MillLine(std::filesystem::path session_file);
    /// Gives up what is under way.
    ~MillLine();
    MillLine(const MillLine&) = delete;
    MillLine& operator=(const MillLine&) = delete;

    /// Puts work at the end of the queue; `ended` is called in the thread with its outcome.
    void add(Errand errand, std::function<void(const Status&, MillLine&)> ended);
    /// Lets all that was added until now, what is under way and what waits behind it, end with an error.
    void give_up();

    // ---- In the thread alone ----

    /// Errors: nobody has signed in.
    Result<wire::MillClient*> client();
    /// Whether the call was given up, if it failed.
    [[nodiscard]] bool is_given_up() const { return m_now <= m_given_up; }
    [[nodiscard]] bool is_signed_out() const { return !m_client || m_client->is_signed_out(); }
    [[nodiscard]] const wire::MillSession& session() const { return m_session; }
    /// From now on as the kept session says.
    Status read_session();
    /// Goes on as this client's person, and keeps the session where `loomlink`'s commands look for it.
    Status adopt(wire::MillClient client);
    /// Forgets the person; server and name are kept.
    Status forget();
    /// Is told of the bodies that go up while an errand runs.
    void tell_progress(std::function<void(std::size_t sent, std::size_t of)> told) {
        m_told = std::move(told);
    }
    /// Makes a client end when the line is given up, and tells its progress.
    void tend(wire::MillClient& client);

  private:
    struct Call {
        Errand errand;
        std::function<void(const Status&, MillLine&)> ended;
        std::uint64_t number = 0;  ///< from 1
    };
    void work();
    Status run(const Errand& errand);
    void use(wire::MillSession session);

    const std::filesystem::path m_file;
    std::mutex m_mutex;
    std::condition_variable m_came;
    std::deque<Call> m_calls;
    std::uint64_t m_added = 0;
    bool m_ends = false;
    std::atomic<std::uint64_t> m_given_up{0};  ///< the last call that is
    std::atomic<bool> m_closes{false};

    // Of the thread alone.
    std::uint64_t m_now = 0;  ///< the call that is under way
    wire::MillSession m_session;
    std::optional<wire::MillClient> m_client;
    std::function<void(std::size_t, std::size_t)> m_told;

    std::thread m_thread;
};

}  // namespace weave::studio
