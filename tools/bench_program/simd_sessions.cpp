#include "simd.hpp"
#include "simd_box.hpp"
#include "table.hpp"

#include <algorithm>
#include <atomic>
#include <csignal>
#include <memory>
#include <mutex>
#include <random>
#include <sys/resource.h>
#include <thread>

namespace weave::bench {

namespace {

using Clock = std::chrono::steady_clock;

struct SessionsWish {
    double seconds = 15;
    std::size_t sessions = 32, points = 2000, rounds = 2, threads = 0;
};

/// What a client saw of a frame.
struct Seen {
    Clock::time_point when;
    std::uint64_t number, step;
};

/// The pace of one session in a stretch of time.
struct Pace {
    double frames_per_s = 0, steps_per_s = 0;
    std::uint64_t lost_frames = 0;  ///< numbers that were jumped over
};

/// Somebody who looks at a session of his or her own that never comes to rest, and changes its parameters now and then.
class Watcher {
  public:
    Watcher(const SimdBox& box, std::size_t person, const std::string& document, sim::Solver solver)
        : m_client(must(wire::Client::connect(box.place_of_person(person), "bench"), "no connection")), m_random(static_cast<unsigned>(person + 1)) {
        constexpr std::chrono::minutes patience{10};
        wire::Simulation simulation = restless();
        simulation.solver = solver;
        const auto made = wire::answer_of<wire::Accepted>(m_client.ask(wire::Create{wire::new_request_id(), document, simulation}, patience));
        m_session = must(made, "a session").session.value();
        must(wire::answer_of<wire::Accepted>(m_client.ask(wire::Run{wire::new_request_id(), m_session}, patience)), "a session does not run");
        m_thread = std::thread([this] { watch(); });
    }
    ~Watcher() {
        m_ends = true;
        m_thread.join();
    }
    Watcher(const Watcher&) = delete;
    Watcher& operator=(const Watcher&) = delete;

    [[nodiscard]] std::uint64_t session() const { return m_session; }
    /// What broke it; empty: nothing.
    [[nodiscard]] std::string trouble() const {
        const std::lock_guard lock(m_mutex);
        return m_trouble;
    }
    [[nodiscard]] Pace pace(Clock::time_point from, Clock::time_point to) const {
        const std::lock_guard lock(m_mutex);
        const auto is_within = [&](const Seen& seen) { return seen.when >= from && seen.when <= to; };
        const auto first = std::ranges::find_if(m_seen, is_within);
        const auto end = std::find_if_not(first, m_seen.end(), is_within);
        Pace pace;
        if (end - first < 2) return pace;
        const Seen &begin = *first, &last = *(end - 1);
        const double seconds = std::chrono::duration<double>(last.when - begin.when).count();
        pace.frames_per_s = static_cast<double>(end - first) / std::chrono::duration<double>(to - from).count();
        pace.steps_per_s = static_cast<double>(last.step - begin.step) / seconds;
        pace.lost_frames = last.number - begin.number - static_cast<std::uint64_t>(end - first - 1);
        return pace;
    }

  private:
    void watch() {
        constexpr std::chrono::milliseconds patience{100};
        Clock::time_point next_change = Clock::now() + pause();
        while (!m_ends) {
            const auto received = m_client.receive(patience);
            if (!received) return give_up(received.error().text());
            if (*received) look(**received);
            if (Clock::now() < next_change) continue;
            next_change = Clock::now() + pause();
            if (!m_client.send(wire::MakeChange{wire::new_request_id(), m_session, parameters_of_turn(m_changes++)})) return give_up("cannot send");
        }
    }
    void look(const wire::Received& received) {
        if (const auto* frame = std::get_if<wire::Frame>(&received)) {
            const std::lock_guard lock(m_mutex);
            m_seen.push_back({Clock::now(), frame->head.number, frame->head.step});
            return;
        }
        const auto& message = std::get<wire::ServerMessage>(received);
        if (const auto* applied = std::get_if<wire::Applied>(&message)) static_cast<void>(m_client.send(wire::Acknowledge{m_session, applied->seq}));
        if (const auto* ended = std::get_if<wire::Ended>(&message)) give_up("its session has ended: " + (ended->error ? ended->error->text() : ""));
    }
    void give_up(const std::string& why) {
        const std::lock_guard lock(m_mutex);
        m_trouble = why;
    }
    std::chrono::milliseconds pause() { return std::chrono::milliseconds(std::uniform_int_distribution<int>(1500, 4000)(m_random)); }

    wire::Client m_client;
    std::minstd_rand m_random;
    std::uint64_t m_session = 0;
    std::size_t m_changes = 0;
    mutable std::mutex m_mutex;
    std::vector<Seen> m_seen;
    std::string m_trouble;
    std::atomic<bool> m_ends{false};
    std::thread m_thread;
};

/// A client that sends what no program sends, and changes, as fast as they are taken, and reads nothing; on a new connection
/// whenever it is thrown out.
class Hostile {
  public:
    Hostile(const SimdBox& box, std::size_t person, std::uint64_t session) : m_place(box.place_of_person(person)), m_session(session) {
        m_thread = std::thread([this] { rage(); });
    }
    ~Hostile() {
        m_ends = true;
        m_thread.join();
    }
    Hostile(const Hostile&) = delete;
    Hostile& operator=(const Hostile&) = delete;

    std::atomic<std::uint64_t> connections{0}, messages{0};
    std::atomic<double> cpu_s{0};  ///< that its own thread took

  private:
    void rage() {
        while (!m_ends) {
            auto socket = net::WebSocketClient::connect(m_place.options, "/api/v1/wire", {{"Authorization", "Bearer " + m_place.token}});
            if (!socket) {
                std::this_thread::sleep_for(std::chrono::milliseconds(10));
                continue;
            }
            ++connections;
            bool goes_on = socket->send(wire::write_message(wire::Hello{{wire::protocol_version}, "bench"}), false) &&
                           socket->send(wire::write_message(wire::Attach{wire::new_request_id(), m_session, 0, 0}), false);
            for (std::size_t k = 0; goes_on && !m_ends; ++k, ++messages) goes_on = bool(socket->send(nonsense(k), false));
            timespec used{};
            ::clock_gettime(CLOCK_THREAD_CPUTIME_ID, &used);
            cpu_s = static_cast<double>(used.tv_sec) + 1e-9 * static_cast<double>(used.tv_nsec);
        }
    }
    [[nodiscard]] std::string nonsense(std::size_t k) const {
        constexpr std::size_t garbage_every = 20, garbage_bytes = 10'000;
        if (k % garbage_every == 0) return "{\"type\":" + std::string(garbage_bytes, '[');
        return wire::write_message(wire::MakeChange{wire::new_request_id(), m_session, parameters_of_turn(k)});
    }

    const wire::ServerPlace m_place;
    const std::uint64_t m_session;
    std::atomic<bool> m_ends{false};
    std::thread m_thread;
};

/// Kills the worker of a session every second.
class Killer {
  public:
    Killer(const SimdBox& box, std::uint64_t session) : m_box(box), m_session(session), m_thread([this] { haunt(); }) {}
    ~Killer() {
        m_ends = true;
        m_thread.join();
    }
    Killer(const Killer&) = delete;
    Killer& operator=(const Killer&) = delete;

    std::atomic<std::uint64_t> kills{0};

  private:
    void haunt() {
        for (auto next = Clock::now(); !m_ends; next += std::chrono::seconds(1)) {
            std::this_thread::sleep_until(next);
            try {
                const auto worker = m_box.worker(m_session);
                if (worker && ::kill(*worker, SIGKILL) == 0) ++kills;
            } catch (const std::exception&) {  // it was given up, or the daemon is busy
            }
        }
    }

    const SimdBox& m_box;
    const std::uint64_t m_session;
    std::atomic<bool> m_ends{false};
    std::thread m_thread;
};

double own_cpu_s() {
    rusage used{};
    ::getrusage(RUSAGE_SELF, &used);
    const auto seconds = [](const timeval& time) { return static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_usec); };
    return seconds(used.ru_utime) + seconds(used.ru_stime);
}

/// What a stretch of time brought to each session, and the cores that the daemon and the clients took meanwhile.
struct Stretch {
    std::vector<Pace> paces;
    double daemon_cores = 0, client_cores = 0;
};

class Crowd {
  public:
    Crowd(const SessionsWish& wish, sim::Solver solver)
        : m_box(wish.threads, wish.sessions), m_cloth(tiled_cloth(wish.points)), m_seconds(wish.seconds), m_solver(solver) {}

    void grow(std::size_t count) {
        while (m_watchers.size() < count) m_watchers.push_back(std::make_unique<Watcher>(m_box, m_watchers.size(), m_cloth.document, m_solver));
    }
    Stretch measure() {
        constexpr std::chrono::seconds to_settle{2};
        std::this_thread::sleep_for(to_settle);
        const double daemon = m_box.cpu_s(), own = own_cpu_s();
        const auto from = Clock::now(), to = from + std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(m_seconds));
        std::this_thread::sleep_until(to);
        Stretch stretch;
        stretch.daemon_cores = (m_box.cpu_s() - daemon) / m_seconds;
        stretch.client_cores = (own_cpu_s() - own) / m_seconds;
        for (const auto& watcher : m_watchers) stretch.paces.push_back(watcher->pace(from, to));
        return stretch;
    }
    void check(std::size_t ordinary) const {
        for (std::size_t k = 0; k < ordinary; ++k)
            if (const std::string trouble = m_watchers[k]->trouble(); !trouble.empty()) throw std::runtime_error("session " + std::to_string(k + 1) + ": " + trouble);
    }
    [[nodiscard]] const SimdBox& box() const { return m_box; }
    [[nodiscard]] std::size_t points() const { return m_cloth.points; }
    [[nodiscard]] std::uint64_t session(std::size_t person) const { return m_watchers.at(person)->session(); }

  private:
    SimdBox m_box;
    TiledCloth m_cloth;
    double m_seconds;
    sim::Solver m_solver;
    std::vector<std::unique_ptr<Watcher>> m_watchers;
};

double mean_of(const std::vector<Pace>& paces, std::size_t count, double Pace::* what) {
    double sum = 0;
    for (std::size_t k = 0; k < count; ++k) sum += paces[k].*what;
    return sum / static_cast<double>(count);
}

std::uint64_t lost_of(const std::vector<Pace>& paces, std::size_t count) {
    std::uint64_t lost = 0;
    for (std::size_t k = 0; k < count; ++k) lost += paces[k].lost_frames;
    return lost;
}

Json told(const Stretch& stretch, std::size_t count) {
    double slowest = stretch.paces[0].steps_per_s, fastest = slowest;
    for (std::size_t k = 0; k < count; ++k) {
        slowest = std::min(slowest, stretch.paces[k].steps_per_s);
        fastest = std::max(fastest, stretch.paces[k].steps_per_s);
    }
    return {{"sessions", count},
            {"frames_per_s", mean_of(stretch.paces, count, &Pace::frames_per_s)},
            {"steps_per_s", mean_of(stretch.paces, count, &Pace::steps_per_s)},
            {"slowest_steps_per_s", slowest},
            {"fastest_steps_per_s", fastest},
            {"lost_frames", lost_of(stretch.paces, count)},
            {"daemon_cores", stretch.daemon_cores},
            {"client_cores", stretch.client_cores}};
}

/// All but two sessions, beside two ordinary ones and beside a hostile client and a worker that keeps dying, by turns. They
/// compute in time steps, each of which costs the same, so that the steps of one stretch can be held against those of another.
Json beside_trouble(const SessionsWish& wish, const CommandOutcome& outcome) {
    outcome.note(std::to_string(wish.sessions) + " side by side, in time steps");
    Crowd crowd(wish, sim::Solver::paper);
    crowd.grow(wish.sessions);
    const std::size_t others = wish.sessions - 2;
    std::vector<double> calm(others), troubled(others);
    Json answer{{"others", others}, {"stretches", Json::array()}};
    std::uint64_t kills = 0, connections = 0, messages = 0, lost = 0;
    double calm_clients = 0, troubled_clients = 0;  // cores
    double calm_frames = 0, troubled_frames = 0;    // of all others, a second
    for (std::size_t round = 0; round < 2 * wish.rounds; ++round) {
        const bool is_troubled = round % 2 == 1;
        outcome.note(is_troubled ? "beside a hostile client and a dying worker" : "beside two ordinary sessions");
        Stretch stretch;
        if (is_troubled) {
            Hostile hostile(crowd.box(), others, crowd.session(others));
            Killer killer(crowd.box(), crowd.session(others + 1));
            stretch = crowd.measure();
            kills += killer.kills, connections += hostile.connections, messages += hostile.messages;
            lost += lost_of(stretch.paces, others);
        } else {
            stretch = crowd.measure();
        }
        crowd.check(others);
        for (std::size_t k = 0; k < others; ++k) (is_troubled ? troubled : calm)[k] += stretch.paces[k].steps_per_s;
        Json one = told(stretch, others);
        one["troubled"] = is_troubled;
        (is_troubled ? troubled_frames : calm_frames) += mean_of(stretch.paces, others, &Pace::frames_per_s);
        (is_troubled ? troubled_clients : calm_clients) += stretch.client_cores / static_cast<double>(wish.rounds);
        answer["stretches"].push_back(std::move(one));
    }
    double all_calm = 0, all_troubled = 0;
    std::vector<double> shares;
    for (std::size_t k = 0; k < others; ++k) {
        all_calm += calm[k], all_troubled += troubled[k];
        shares.push_back(calm[k] > 0 ? troubled[k] / calm[k] : 0);
    }
    if (all_calm <= 0) throw std::runtime_error("no session shows two frames in a stretch: give it more --seconds");
    std::sort(shares.begin(), shares.end());
    answer.update({{"pace_kept", all_troubled / all_calm}, {"least_pace_kept", shares.front()}, {"frames_kept", troubled_frames / calm_frames}, {"lost_frames", lost}, {"kills", kills},
                   {"calm_client_cores", calm_clients}, {"troubled_client_cores", troubled_clients},
                   {"hostile_connections", connections}, {"hostile_messages", messages}});
    return answer;
}

std::string words_of(const SessionsWish& wish, const Json& said) {
    AimTable table("simd-sessions: " + told_circumstances(said.at("before"), said.at("after")) + "; sessions of " +
                   std::to_string(said.at("points").get<std::size_t>()) + " points, " + form("%.0f s", wish.seconds) + " each");
    for (const Json& one : said.at("side_by_side")) {
        table.row(std::to_string(one.at("sessions").get<std::size_t>()) + " side by side, each: frames and steps a second",
                  form("%.1f", one.at("frames_per_s")) + " and " + form("%.0f", one.at("steps_per_s")) + " (steps: slowest " + form("%.0f", one.at("slowest_steps_per_s")) +
                      ", fastest " + form("%.0f", one.at("fastest_steps_per_s")) + "); daemon " + form("%.2f", one.at("daemon_cores")) + ", clients " +
                      form("%.2f cores", one.at("client_cores")));
    }
    if (!said.contains("trouble")) return table.text();
    const Json& trouble = said.at("trouble");
    constexpr double least = 0.9;
    const double kept = trouble.at("pace_kept");
    table.row(std::to_string(trouble.at("others").get<std::size_t>()) + " others beside a hostile client (" + form("%.0f messages, ", trouble.at("hostile_messages")) +
                  form("%.0f connections) and a worker that was killed ", trouble.at("hostile_connections")) + form("%.0f times: their steps", trouble.at("kills")),
              form("%.1f %%", 100 * kept) + ", that of the one that lost most " + form("%.1f %%", 100 * trouble.at("least_pace_kept").get<double>()), "90 %", kept >= least);
    const double frames = trouble.at("frames_kept");
    table.row("the same: their frames, of which each turn shows one", form("%.1f %%", 100 * frames), "90 %", frames >= least);
    table.row("cores that the clients took of this machine, which they would not have elsewhere: without and with the hostile one",
              form("%.2f", trouble.at("calm_client_cores")) + " and " + form("%.2f", trouble.at("troubled_client_cores")));
    table.row("frames of theirs that they did not get", form("%.0f", trouble.at("lost_frames")), "0", trouble.at("lost_frames") == 0);
    return table.text();
}

void side_by_side(const SessionsWish& wish, const CommandOutcome& outcome, Json& said) {
    Crowd crowd(wish, sim::Solver::relax);
    said["points"] = crowd.points();
    for (const std::size_t count : {std::size_t{1}, std::size_t{8}, wish.sessions}) {
        if (count > wish.sessions || (count == wish.sessions && !said["side_by_side"].empty() && said["side_by_side"].back().at("sessions") == count)) continue;
        outcome.note(std::to_string(count) + " side by side");
        crowd.grow(count);
        said["side_by_side"].push_back(told(crowd.measure(), count));
        crowd.check(count);
    }
}

Status sessions(const SessionsWish& wish, CommandOutcome& outcome) {
    Json said{{"before", circumstances()}, {"seconds", wish.seconds}, {"side_by_side", Json::array()}};
    side_by_side(wish, outcome, said);
    if (wish.sessions > 2) said["trouble"] = beside_trouble(wish, outcome);
    said["after"] = circumstances();
    outcome.answer(said, words_of(wish, said));
    return {};
}

}  // namespace

void add_simd_sessions(CLI::App& app, CommandOutcome& outcome) {
    CLI::App* const command = add_command(app, outcome, "simd-sessions", "The pace of sessions side by side, and beside a hostile client and a dying worker",
                                          "tools/bench simd-sessions --seconds 30");
    auto wish = std::make_shared<SessionsWish>();
    command->add_option("--sessions", wish->sessions, "sessions at most (32); 1 and 8 are measured as well")->check(CLI::Range(1, 200));
    command->add_option("--points", wish->points, "control points of each (2000)")->check(CLI::Range(1, 1'000'000));
    command->add_option("--seconds", wish->seconds, "of each stretch that is measured (15)")->check(CLI::Range(0.5, 3600.0));
    command->add_option("--rounds", wish->rounds, "stretches without and with trouble (2)")->check(CLI::Range(1, 100));
    command->add_option("--threads", wish->threads, "threads of simd that compute; 0: one a core")->check(CLI::Range(0, 1024));
    on_run(command, outcome, [wish, &outcome] { return sessions(*wish, outcome); });
}

}  // namespace weave::bench
