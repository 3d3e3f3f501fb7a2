#pragma once

#include "box.hpp"

#include <string>
#include <vector>

namespace weave::simd::testing {

/// Has a job queued; its number.
inline std::uint64_t submit(wire::Follower& follower, const std::string& document, const wire::Simulation& simulation, std::vector<Flip> flips = {}) {
    const auto accepted = wire::answer_of<wire::Accepted>(follower.ask(wire::Submit{wire::new_request_id(), document, simulation, std::move(flips)}, 60s));
    INFO((accepted ? "" : accepted.error().text()));
    REQUIRE(accepted);
    return accepted->job.value();
}

/// Waits until this job has ended.
inline wire::JobEnded end_of(wire::Follower& follower, std::uint64_t job) {
    const auto late = std::chrono::steady_clock::now() + 180s;
    while (std::chrono::steady_clock::now() < late) {
        const auto received = follower.receive(200ms);
        INFO((received ? "" : received.error().text()));
        REQUIRE(received);
        const auto* message = *received ? std::get_if<wire::ServerMessage>(&**received) : nullptr;
        if (message == nullptr) continue;
        if (const auto* ended = std::get_if<wire::JobEnded>(message); ended != nullptr && ended->job == job) return *ended;
    }
    FAIL("the job did not end");
    return {};
}

inline std::string yarns_of(wire::Follower& follower, std::uint64_t job) {
    const auto bytes = follower.download(wire::job_yarns(job), std::uint64_t{1} << 30);
    INFO((bytes ? "" : bytes.error().text()));
    REQUIRE(bytes);
    return *bytes;
}

inline void cancel(wire::Follower& follower, std::uint64_t job) {
    const auto accepted = wire::answer_of<wire::Accepted>(follower.ask(wire::Cancel{wire::new_request_id(), job}, 10s));
    INFO((accepted ? "" : accepted.error().text()));
    REQUIRE(accepted);
}

}  // namespace weave::simd::testing
