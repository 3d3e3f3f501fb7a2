#pragma once

#include <weave/sim/run.hpp>
#include <weave/wire/follower.hpp>

#include <chrono>
#include <cstdint>
#include <deque>
#include <map>
#include <optional>
#include <string>
#include <studio/jobs/inbox.hpp>
#include <studio/jobs/outbox.hpp>
#include <studio/jobs/run_meter.hpp>
#include <studio/jobs/server_place.hpp>

namespace weave::studio {

/// The work of one run on a server: a session that it follows, and asks for what the window wants.
/// Connections may break; what was asked for is asked for again.
class RemoteWork {
  public:
    RemoteWork(Design design, sim::RunRequest request, ServerWish server, Inbox& inbox, Outbox& outbox);
    void run(std::chrono::milliseconds patience);

  private:
    Status begin(std::chrono::milliseconds patience);
    Status loop();
    void finish();
    bool bring_to_stand();
    [[nodiscard]] bool is_heard() const;

    // What is asked.
    Status send_orders();
    Status send(const Order& order);
    Status refuse(const Order& order, const wire::Refused& refused);
    [[nodiscard]] wire::ClientMessage message_of(const Order& order, const std::string& request) const;
    /// Nothing where the run is to finish before an answer came.
    Result<std::optional<wire::ServerMessage>> ask(const wire::ClientMessage& message);

    // What comes.
    Status take_news(std::chrono::milliseconds most);
    Status take(const wire::ServerMessage& message);
    Status take(const wire::Ended& ended);
    void take(const wire::PhaseChanged& changed);
    void take(const wire::Applied& applied);
    void take(const wire::Flipped& flipped);
    void take(const wire::Recovered& recovered);
    void take(wire::Frame frame);

    void tell_trouble(std::string words);
    void fetch_yarns();
    bool fetch_yarns_now();

    Design m_design;
    sim::RunRequest m_request;
    ServerWish m_server;
    Inbox& m_inbox;
    Outbox& m_outbox;
    std::optional<wire::Follower> m_follower;
    std::uint64_t m_session = 0;
    RunMeter m_meter;
    wire::Phase m_phase = wire::Phase::paused;
    bool m_wants_yarns = false, m_leads = false, m_is_over = false;
    std::map<std::string, Flip> m_flips;  ///< that have not ended, by their request
    std::string m_trouble;
    std::chrono::steady_clock::time_point m_next_fetch{};
};

}  // namespace weave::studio
