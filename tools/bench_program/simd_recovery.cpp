#include "simd.hpp"
#include "simd_box.hpp"
#include "spread.hpp"
#include "table.hpp"

#include <weave/wire/follower.hpp>

#include <algorithm>
#include <atomic>
#include <csignal>
#include <functional>
#include <memory>
#include <mutex>
#include <random>
#include <thread>

namespace weave::bench {

namespace {

using Clock = std::chrono::steady_clock;

struct RecoveryWish {
    double seconds = 60;
    std::size_t sessions = 16, points = 2000, kills = 20, restarts = 3, threads = 0;
};

/// A session that never comes to rest, with a client that comes back whatever breaks.
class Survivor {
  public:
    Survivor(const SimdBox& box, const std::string& document) : m_follower(must(wire::Follower::connect(box.place(), "bench", patience), "no connection")) {
        m_session = must(m_follower.create(document, restless(), patience), "a session").session.value();
        must(wire::answer_of<wire::Accepted>(m_follower.ask(wire::Run{wire::new_request_id(), m_session}, patience)), "a session does not run");
        m_thread = std::thread([this] { watch(); });
    }
    ~Survivor() {
        m_ends = true;
        m_thread.join();
    }
    Survivor(const Survivor&) = delete;
    Survivor& operator=(const Survivor&) = delete;

    /// What was seen of it, up to now.
    struct Seen {
        std::size_t recoveries = 0;
        std::uint64_t step = 0, number = 0, lost_frames = 0;
        std::uint64_t recovered_step = 0, before_step = 0;  ///< of the last recovery: its checkpoint, and the last frame before
        Clock::time_point recovered{}, moved{};  ///< when it was told of; when a frame showed a step after it
    };
    [[nodiscard]] Seen seen() const {
        const std::lock_guard lock(m_mutex);
        if (!m_trouble.empty()) throw std::runtime_error("session " + std::to_string(m_session) + ": " + m_trouble);
        return m_seen;
    }
    [[nodiscard]] std::uint64_t session() const { return m_session; }
    [[nodiscard]] Clock::time_point began() const { return m_began; }

  private:
    void watch() {
        constexpr std::chrono::milliseconds short_while{100};
        while (!m_ends) {
            const auto received = m_follower.receive(short_while);
            const std::lock_guard lock(m_mutex);
            if (!received) {
                m_trouble = received.error().text();
                return;
            }
            if (*received) look(**received);
        }
    }
    void look(const wire::Received& received) {
        if (const auto* frame = std::get_if<wire::Frame>(&received)) {
            if (m_seen.number > 0 && !m_is_back) m_seen.lost_frames += frame->head.number - m_seen.number - 1;
            m_seen.number = frame->head.number;
            m_seen.step = frame->head.step;
            if (m_is_back && frame->head.step > m_seen.recovered_step) {
                m_seen.moved = Clock::now();
                m_is_back = false;
                ++m_seen.recoveries;
            }
            return;
        }
        const auto& message = std::get<wire::ServerMessage>(received);
        if (const auto* recovered = std::get_if<wire::Recovered>(&message)) {
            m_seen.recovered = Clock::now();
            m_seen.recovered_step = recovered->step;
            m_seen.before_step = m_seen.step;
            m_is_back = true;
        }
        if (const auto* ended = std::get_if<wire::Ended>(&message)) m_trouble = "has ended: " + (ended->error ? ended->error->text() : "");
    }

    static constexpr std::chrono::minutes patience{5};
    wire::Follower m_follower;
    std::uint64_t m_session = 0;
    const Clock::time_point m_began = Clock::now();
    mutable std::mutex m_mutex;
    Seen m_seen;
    bool m_is_back = false;
    std::string m_trouble;
    std::atomic<bool> m_ends{false};
    std::thread m_thread;
};

using Survivors = std::vector<std::unique_ptr<Survivor>>;

void wait_until(const std::function<bool()>& is_so) {
    constexpr std::chrono::minutes most{5};
    constexpr std::chrono::milliseconds between_looks{5};
    for (const auto late = Clock::now() + most; !is_so();) {
        if (Clock::now() > late) throw std::runtime_error("a session does not go on after minutes");
        std::this_thread::sleep_for(between_looks);
    }
}

/// A fault is to hit what is under way.
void wait_until_all_move(const Survivors& survivors) {
    wait_until([&] { return std::ranges::all_of(survivors, [](const auto& one) { return one->seen().step > 0; }); });
}

/// Of the state from which a session would go on now: its checkpoint, or its beginning.
double age_s(const SimdBox& box, const Survivor& survivor) {
    return box.checkpoint_age_s(survivor.session()).value_or(std::chrono::duration<double>(Clock::now() - survivor.began()).count());
}

std::vector<double> sorted_of(const Json& faults, const char* what) {
    std::vector<double> values;
    for (const Json& fault : faults) values.push_back(fault.at(what));
    std::sort(values.begin(), values.end());
    return values;
}

Json spread_of(const Json& faults) {
    Json spread;
    for (const char* what : {"recovered_s", "moved_s", "checkpoint_age_s", "steps_again"}) {
        const std::vector<double> values = sorted_of(faults, what);
        spread[what] = {{"p50", percentile(values, 0.5)}, {"max", percentile(values, 1)}};
    }
    return spread;
}

double between_s(Clock::time_point from, Clock::time_point to) {
    return std::chrono::duration<double>(to - from).count();
}

Json kill_workers(const SimdBox& box, const Survivors& survivors, std::size_t kills, const CommandOutcome& outcome) {
    std::minstd_rand random{7};
    Json faults = Json::array();
    std::uint64_t lost = 0;
    for (std::size_t k = 0; k < kills; ++k) {
        std::this_thread::sleep_for(std::chrono::milliseconds(std::uniform_int_distribution<int>(200, 4000)(random)));
        const std::size_t victim = std::uniform_int_distribution<std::size_t>(0, survivors.size() - 1)(random);
        const Survivor& one = *survivors[victim];
        const auto worker = box.worker(one.session());
        const double age = age_s(box, one);
        if (!worker) continue;
        std::vector<Survivor::Seen> before;
        for (const auto& other : survivors) before.push_back(other->seen());
        const Clock::time_point fault = Clock::now();
        if (::kill(*worker, SIGKILL) != 0) continue;
        wait_until([&] { return one.seen().recoveries > before[victim].recoveries; });
        const Survivor::Seen seen = one.seen();
        for (std::size_t other = 0; other < survivors.size(); ++other)
            if (other != victim) lost += survivors[other]->seen().lost_frames - before[other].lost_frames;
        faults.push_back({{"recovered_s", between_s(fault, seen.recovered)},
                          {"moved_s", between_s(fault, seen.moved)},
                          {"checkpoint_age_s", age},
                          {"steps_again", seen.before_step > seen.recovered_step ? seen.before_step - seen.recovered_step : 0}});
        outcome.note("worker " + std::to_string(k + 1) + " of " + std::to_string(kills) + ": on after " + form("%.2f s", faults.back().at("moved_s")));
    }
    return {{"faults", faults}, {"spread", spread_of(faults)}, {"frames_lost_by_others", lost}};
}

/// The daemon dies, and is started again at once, as systemd does.
Json kill_daemon(SimdBox& box, const Survivors& survivors, std::size_t restarts, const CommandOutcome& outcome) {
    Json answer{{"restarts", Json::array()}};
    Json faults = Json::array();
    for (std::size_t k = 0; k < restarts; ++k) {
        std::this_thread::sleep_for(std::chrono::seconds(5));
        std::vector<std::size_t> before;
        std::vector<double> ages;
        for (const auto& one : survivors) before.push_back(one->seen().recoveries), ages.push_back(age_s(box, *one));
        const Clock::time_point fault = Clock::now();
        box.kill();
        box.start();
        const double serves_s = between_s(fault, Clock::now());
        double all_s = 0;
        for (std::size_t s = 0; s < survivors.size(); ++s) {
            wait_until([&] { return survivors[s]->seen().recoveries > before[s]; });
            const Survivor::Seen seen = survivors[s]->seen();
            all_s = std::max(all_s, between_s(fault, seen.moved));
            faults.push_back({{"recovered_s", between_s(fault, seen.recovered)}, {"moved_s", between_s(fault, seen.moved)}, {"checkpoint_age_s", ages[s]},
                              {"steps_again", seen.before_step > seen.recovered_step ? seen.before_step - seen.recovered_step : 0}});
        }
        answer["restarts"].push_back({{"serves_s", serves_s}, {"all_go_on_s", all_s}});
        outcome.note("daemon " + std::to_string(k + 1) + " of " + std::to_string(restarts) + ": all on after " + form("%.1f s", all_s));
    }
    answer["spread"] = spread_of(faults);
    return answer;
}

void tell(AimTable& table, const std::string& what, const Json& spread) {
    constexpr double most_s = 10, oldest_s = 30;
    const auto text = [&](const char* member, const char* how) {
        return "p50 " + form(how, spread.at(member).at("p50")) + ", most " + form(how, spread.at(member).at("max"));
    };
    const auto within = [&](const char* member, double most) { return spread.at(member).at("max").get<double>() <= most; };
    table.row(what + " until `recovered`", text("recovered_s", "%.2f s"));
    table.row(what + " until a frame shows a new step", text("moved_s", "%.2f s"), "10 s", within("moved_s", most_s));
    table.row(what + ": age of the state from which it went on", text("checkpoint_age_s", "%.1f s"), "30 s", within("checkpoint_age_s", oldest_s));
    table.row(what + ": steps made again", text("steps_again", "%.0f"));
}

std::string words_of(const RecoveryWish& wish, const Json& said) {
    AimTable table("simd-recovery: " + told_circumstances(said.at("before"), said.at("after")) + "; " + std::to_string(wish.sessions) + " sessions of " +
                   std::to_string(said.at("points").get<std::size_t>()) + " points, all running");
    const Json& workers = said.at("workers");
    tell(table, "kill -9 of a worker (" + std::to_string(workers.at("faults").size()) + ")", workers.at("spread"));
    table.row("frames that the others did not get meanwhile", form("%.0f", workers.at("frames_lost_by_others")), "0", workers.at("frames_lost_by_others") == 0);
    if (!said.contains("daemon")) return table.text();
    const Json& daemon = said.at("daemon");
    const std::string what = "kill -9 of the daemon, started again (" + std::to_string(daemon.at("restarts").size()) + ")";
    table.row(what + " until it serves", form("most %.2f s", sorted_of(daemon.at("restarts"), "serves_s").back()));
    table.row(what + " until all go on", form("most %.1f s", sorted_of(daemon.at("restarts"), "all_go_on_s").back()));
    tell(table, what, daemon.at("spread"));
    return table.text();
}

Status recovery(const RecoveryWish& wish, CommandOutcome& outcome) {
    Json said{{"before", circumstances()}};
    SimdBox box(wish.threads);
    const TiledCloth cloth = tiled_cloth(wish.points);
    said["points"] = cloth.points;
    Survivors survivors;
    for (std::size_t k = 0; k < wish.sessions; ++k) survivors.push_back(std::make_unique<Survivor>(box, cloth.document));
    outcome.note(std::to_string(wish.sessions) + " sessions run");
    wait_until_all_move(survivors);
    std::this_thread::sleep_for(std::chrono::duration<double>(wish.seconds));
    said["workers"] = kill_workers(box, survivors, wish.kills, outcome);
    if (wish.restarts > 0) said["daemon"] = kill_daemon(box, survivors, wish.restarts, outcome);
    said["after"] = circumstances();
    outcome.answer(said, words_of(wish, said));
    return {};
}

}  // namespace

void add_simd_recovery(CLI::App& app, CommandOutcome& outcome) {
    CLI::App* const command = add_command(app, outcome, "simd-recovery", "How soon sessions go on after kill -9 of a worker, and of the daemon",
                                          "tools/bench simd-recovery --kills 100");
    auto wish = std::make_shared<RecoveryWish>();
    command->add_option("--sessions", wish->sessions, "sessions side by side (16)")->check(CLI::Range(1, 200));
    command->add_option("--points", wish->points, "control points of each (2000)")->check(CLI::Range(1, 1'000'000));
    command->add_option("--seconds", wish->seconds, "that they run before the first fault (60)")->check(CLI::Range(0.0, 3600.0));
    command->add_option("--kills", wish->kills, "workers that are killed (20)")->check(CLI::Range(1, 100'000));
    command->add_option("--restarts", wish->restarts, "times that the daemon is killed (3)")->check(CLI::Range(0, 1000));
    command->add_option("--threads", wish->threads, "threads of simd that compute; 0: one a core")->check(CLI::Range(0, 1024));
    on_run(command, outcome, [wish, &outcome] { return recovery(*wish, outcome); });
}

}  // namespace weave::bench
