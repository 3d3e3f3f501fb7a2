#include <loomlink/commands/loom_watch.hpp>

#include <weave/net/websocket_client.hpp>

#include <algorithm>
#include <loomlink/workflow/desk.hpp>
#include <optional>
#include <thread>

namespace weave::loomlink {

namespace {

using std::chrono::seconds;

class LoomWatch {
  public:
    LoomWatch(wire::MillClient& client, const PullWish& wish, seconds every, const SignInAgain& sign_in_again,
              CommandOutcome& outcome)
        : m_client(&client),
          m_wish(&wish),
          m_every(every),
          m_sign_in_again(&sign_in_again),
          m_outcome(&outcome) {}

    Status run() {
        while (true) {
            // The socket first: what changes while a pull goes on is told on it.
            auto socket = m_client->watch(wire::mill_path({"looms", m_wish->loom, "watch"}));
            do {
                WEAVE_CHECK_OK(round());
            } while (socket && waits_on(*socket));
            m_failures = socket && m_trouble.empty() ? 0 : m_failures + 1;
            std::this_thread::sleep_for(pause());
        }
    }

  private:
    /// One pull, and what is to be told of it.
    Status round() {
        auto report = pull_signed_in(*m_client, *m_wish, *m_sign_in_again);
        if (!report) {
            if (!m_pulled_once && report.error().code != ErrorCode::system) return std::move(report).error();
            tell_trouble(report.error());
            return {};
        }
        if (!m_trouble.empty()) m_outcome->note("the server answers again");
        m_trouble.clear();
        const std::size_t kept = report->kept.size();
        std::string refused;
        for (const RefusedRelease& one : report->refused)
            refused += std::to_string(one.number) + ": " + one.error.text() + "\n";
        if (report->has_news() || !m_pulled_once || kept != m_kept || refused != m_refused)
            m_outcome->answer(to_json(*report, m_wish->loom), in_words(*report, m_wish->loom));
        m_pulled_once = true;
        m_kept = kept;
        m_refused = refused;
        m_expires = report->expires;
        return {};
    }

    /// Each trouble is told once, and once that the index has run out meanwhile.
    void tell_trouble(const Error& error) {
        if (m_trouble != error.text()) m_outcome->note(error.text() + "; trying on");
        m_trouble = error.text();
        if (!m_expires || system_clock()() < *m_expires) return;
        m_outcome->note("the last index has run out at " + utc_text(*m_expires) +
                        ": start nothing new until the server answers");
        m_expires.reset();
    }

    /// Whether there is a reason to pull again on this connection: a change, or that it is time.
    bool waits_on(net::WebSocketClient& socket) {
        return m_trouble.empty() && socket.receive(m_every).operator bool();
    }

    /// Longer from failure to failure, up to a minute; a moment where only the connection ended.
    [[nodiscard]] seconds pause() const {
        constexpr int most_doublings = 6;
        return std::min({seconds(1 << std::min(m_failures, most_doublings)), seconds(60), m_every});
    }

    wire::MillClient* m_client;
    const PullWish* m_wish;
    seconds m_every;
    const SignInAgain* m_sign_in_again;
    CommandOutcome* m_outcome;
    bool m_pulled_once = false;
    int m_failures = 0;  ///< connections in a row that failed or brought trouble
    std::size_t m_kept = 0;
    std::string m_refused;  ///< what could not be had the last time
    std::string m_trouble;  ///< the last one that was told; empty: all is well
    std::optional<Instant> m_expires;
};

}  // namespace

Result<PullReport> pull_signed_in(wire::MillClient& client, const PullWish& wish, const SignInAgain& sign_in_again) {
    auto report = pull(client, wish);
    if (report || !client.is_signed_out() || !sign_in_again) return report;
    WEAVE_CHECK_OK(sign_in_again(client));
    return pull(client, wish);
}

Status watch_loom(wire::MillClient& client, const PullWish& wish, seconds every, const SignInAgain& sign_in_again,
                  CommandOutcome& outcome) {
    return LoomWatch(client, wish, every, sign_in_again, outcome).run();
}

}  // namespace weave::loomlink
