#pragma once

#include <weave/core/instrumented.hpp>
#include <weave/core/json.hpp>
#include <weave/design/document.hpp>
#include <weave/samples/samples.hpp>
#include <weave/wire/follower.hpp>

#include <catch2/catch.hpp>

#include <chrono>
#include <csignal>
#include <fstream>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <support/program.hpp>
#include <support/temporary_folder.hpp>
#include <thread>
#include <vector>

namespace weave::simd::testing {

using namespace std::chrono_literals;

/// How long a test waits for what must come. What is watched takes ten times the time.
constexpr std::chrono::seconds patience_for_news{is_instrumented ? 600 : 120}, patience_for_rest{is_instrumented ? 1200 : 180};

/// A daemon of its own, as people start it, in a folder that goes away with the test.
class Box {
  public:
    explicit Box(Json config = Json::object()) : m_config(std::move(config)) {
        if (!m_config.contains("address")) m_config["address"] = "";
        start();
    }

    void start() {
        std::ofstream(config_file()) << m_config.dump();
        m_program.emplace("simd", std::vector<std::string>{"serve", folder().string(), "--config", config_file().string(), "--json"}, told_file());
        const std::string line = m_program->line();
        INFO("what it tells people: " << told());
        auto answer = parse_json(line);
        REQUIRE(answer);
        REQUIRE_FALSE(answer->contains("error"));
        introduction = std::move(*answer);
    }
    /// As a fault of the machine ends it.
    void kill() {
        m_program->end(SIGKILL);
        m_program->exit_code();
    }
    /// As systemd does; the exit status.
    int stop() {
        m_program->end(SIGTERM);
        return m_program->exit_code();
    }
    [[nodiscard]] pid_t process() const { return m_program->process(); }

    [[nodiscard]] std::filesystem::path folder() const { return m_folder.path / "box"; }
    [[nodiscard]] std::filesystem::path config_file() const { return m_folder.path / "config.json"; }
    [[nodiscard]] std::string told_file() const { return (m_folder.path / "told").string(); }
    [[nodiscard]] std::string told() const {
        std::ifstream file(told_file());
        return {std::istreambuf_iterator<char>(file), {}};
    }

    /// Its Unix socket: as the machine's owner.
    [[nodiscard]] wire::ServerPlace place() const { return wire::place_of("unix:" + (folder() / "simd.sock").string()).value(); }
    [[nodiscard]] wire::Follower follower(std::chrono::milliseconds patience = 60s) const {
        auto follower = wire::Follower::connect(place(), "test", patience);
        INFO((follower ? "" : follower.error().text()) << "; told: " << told());
        REQUIRE(follower);
        return std::move(*follower);
    }
    [[nodiscard]] Json status() const {
        const auto text = wire::download(place(), "/api/v1/status", 1 << 24);
        INFO((text ? "" : text.error().text()));
        REQUIRE(text);
        return parse_json(*text).value();
    }
    /// The worker of a session (or, with `job`, of a job); nothing while it has none.
    [[nodiscard]] std::optional<pid_t> worker(const char* what, std::uint64_t number) const {
        const Json now = status();
        for (const Json& one : now.at(std::string(what) + "s")) {
            if (one.at(what) == number && one.contains("worker")) return one.at("worker").get<pid_t>();
        }
        return {};
    }

    Json introduction;

  private:
    weave::testing::TemporaryFolder m_folder;
    Json m_config;
    std::optional<weave::testing::Program> m_program;
};

inline std::string document_of(const std::string& sample) {
    return write_document(find_sample(sample)->make());
}

/// A session that somebody follows, with all that was told of it.
class Followed {
  public:
    Followed(const Box& box, const std::string& document, const wire::Simulation& simulation) : Followed(box.follower(), document, simulation) {}
    Followed(wire::Follower follower, const std::string& document, const wire::Simulation& simulation) : m_follower(std::move(follower)) {
        auto accepted = m_follower.create(document, simulation, 60s);
        INFO((accepted ? "" : accepted.error().text()));
        REQUIRE(accepted);
        number = accepted->session.value();
        REQUIRE(until_phase(wire::Phase::paused));
    }

    /// Asks, and expects that it is granted.
    wire::ServerMessage ask(const wire::ClientMessage& message) {
        auto answer = m_follower.ask(message, 60s);
        INFO((answer ? wire::write_message(*answer) : answer.error().text()));
        REQUIRE(answer);
        REQUIRE_FALSE(std::holds_alternative<wire::Refused>(*answer));
        return std::move(*answer);
    }
    void run() { ask(wire::Run{wire::new_request_id(), number}); }
    std::string change(const wire::Change& change) {
        std::string request = wire::new_request_id();
        ask(wire::MakeChange{request, number, change});
        return request;
    }
    wire::State state() { return std::get<wire::State>(ask(wire::ReadState{wire::new_request_id(), number})); }

    /// Takes what comes until `enough`; whether that came in time.
    bool until(const std::function<bool(const wire::Received&)>& enough, std::chrono::milliseconds patience = patience_for_news) {
        const auto end = std::chrono::steady_clock::now() + patience;
        while (std::chrono::steady_clock::now() < end) {
            auto received = m_follower.receive(100ms);
            INFO((received ? "" : received.error().text()));
            REQUIRE(received);
            if (!*received) continue;
            const wire::Received& one = **received;
            if (const auto* message = std::get_if<wire::ServerMessage>(&one)) {
                told.push_back(*message);
            } else {
                const auto& frame = std::get<wire::Frame>(one);
                CHECK(frame.head.number > last_frame);
                last_frame = frame.head.number;
                newest = frame;
            }
            if (enough(one)) return true;
        }
        return false;
    }
    template <class Message>
    std::optional<Message> next(std::chrono::milliseconds patience = patience_for_news, const std::function<bool(const Message&)>& fits = {}) {
        std::optional<Message> found;
        until(
            [&](const wire::Received& received) {
                const auto* message = std::get_if<wire::ServerMessage>(&received);
                const auto* wanted = message == nullptr ? nullptr : std::get_if<Message>(message);
                if (wanted == nullptr || (fits && !fits(*wanted))) return false;
                found = *wanted;
                return true;
            },
            patience);
        return found;
    }
    bool until_phase(wire::Phase phase, std::chrono::milliseconds patience = patience_for_rest) {
        return next<wire::PhaseChanged>(patience, [&](const auto& changed) { return changed.phase == phase; }).has_value();
    }
    /// Until it rests, and shows so.
    bool until_rest(std::chrono::milliseconds patience = patience_for_rest) {
        return until(
            [](const wire::Received& one) {
                const auto* frame = std::get_if<wire::Frame>(&one);
                return frame != nullptr && frame->head.at_rest;
            },
            patience);
    }
    /// The yarns as they lie.
    std::string yarns() {
        auto bytes = m_follower.download(wire::session_yarns(number), std::uint64_t{1} << 30);
        INFO((bytes ? "" : bytes.error().text()));
        REQUIRE(bytes);
        return std::move(*bytes);
    }
    template <class Message>
    [[nodiscard]] std::vector<Message> all() const {
        std::vector<Message> found;
        for (const wire::ServerMessage& message : told) {
            if (const auto* wanted = std::get_if<Message>(&message)) found.push_back(*wanted);
        }
        return found;
    }
    [[nodiscard]] wire::Follower& follower() { return m_follower; }

    std::uint64_t number = 0, last_frame = 0;
    std::vector<wire::ServerMessage> told;
    std::optional<wire::Frame> newest;

  private:
    wire::Follower m_follower;
};

inline wire::Simulation at(sim::Fidelity fidelity) {
    wire::Simulation simulation;
    simulation.plan.fidelity = fidelity;
    return simulation;
}

}  // namespace weave::simd::testing
