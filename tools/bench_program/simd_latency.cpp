#include "simd.hpp"
#include "simd_box.hpp"
#include "spread.hpp"
#include "table.hpp"

#include <weave/design/document.hpp>
#include <weave/design/evaluate.hpp>

#include <algorithm>
#include <functional>
#include <memory>
#include <random>
#include <thread>

namespace weave::bench {

namespace {

using Clock = std::chrono::steady_clock;

struct LatencyWish {
    std::size_t changes = 100, cancels = 30, flips = 20, threads = 0;
    std::vector<std::size_t> points{2000, 20000};
};

double ms_since(Clock::time_point then) {
    return std::chrono::duration<double, std::milli>(Clock::now() - then).count();
}

/// Somebody does not press a button in step with the machine.
void hesitate() {
    static std::minstd_rand random{1};
    std::this_thread::sleep_for(std::chrono::milliseconds(std::uniform_int_distribution<int>(0, 150)(random)));
}

/// A connection whose messages are looked at the moment they come.
class Line {
  public:
    explicit Line(const wire::ServerPlace& place) : m_client(must(wire::Client::connect(place, "bench"), "no connection")) {}

    void send(const wire::ClientMessage& message) { must(m_client.send(message), "nothing can be sent"); }
    /// The next message or frame. A refusal is an exception.
    wire::Received next() {
        constexpr std::chrono::minutes patience{5};
        auto received = must(m_client.receive(patience), "the connection");
        if (!received) throw std::runtime_error("simd says nothing for minutes");
        if (const auto* message = std::get_if<wire::ServerMessage>(&*received)) {
            if (const auto* refused = std::get_if<wire::Refused>(message)) throw std::runtime_error("refused: " + refused->error.text());
        }
        return std::move(*received);
    }
    template <class Message>
    Message until(const std::function<bool(const Message&)>& fits) {
        constexpr std::chrono::minutes most{5};
        for (const auto late = Clock::now() + most; Clock::now() < late;) {
            const wire::Received received = next();
            const auto* message = std::get_if<wire::ServerMessage>(&received);
            const auto* wanted = message == nullptr ? nullptr : std::get_if<Message>(message);
            if (wanted != nullptr && fits(*wanted)) return *wanted;
        }
        throw std::runtime_error("simd does not tell what it should for minutes");
    }
    wire::Accepted accepted(const std::string& request) {
        return until<wire::Accepted>([&](const wire::Accepted& answer) { return answer.request == request; });
    }

  private:
    wire::Client m_client;
};

/// A session that runs, and how long things take in it.
class Subject {
  public:
    Subject(const wire::ServerPlace& place, const std::string& document, const wire::Simulation& simulation) : m_line(place) {
        const std::string made = wire::new_request_id(), begun = wire::new_request_id();
        m_line.send(wire::Create{made, document, simulation});
        m_session = m_line.accepted(made).session.value();
        m_line.send(wire::Run{begun, m_session});
        m_line.accepted(begun);
        while (true) {
            const wire::Received received = m_line.next();
            const auto* frame = std::get_if<wire::Frame>(&received);
            if (frame != nullptr && frame->head.step > 0) return;
        }
    }
    ~Subject() {
        const std::string request = wire::new_request_id();
        try {
            m_line.send(wire::Close{request, m_session});
            m_line.accepted(request);
        } catch (const std::exception&) {  // its daemon ends anyway
        }
    }
    Subject(const Subject&) = delete;
    Subject& operator=(const Subject&) = delete;

    void change(std::size_t turn) {
        const std::string request = wire::new_request_id();
        const Clock::time_point sent = Clock::now();
        m_line.send(wire::MakeChange{request, m_session, parameters_of_turn(turn)});
        std::optional<std::uint64_t> applied_before;
        for (bool is_accepted = false, is_shown = false; !is_accepted || !is_shown;) {
            const wire::Received received = m_line.next();
            const double ms = ms_since(sent);
            if (const auto* frame = std::get_if<wire::Frame>(&received)) {
                if (!applied_before || is_shown || frame->head.step <= *applied_before) continue;
                shown.push_back(ms);
                is_shown = true;
                continue;
            }
            const auto& message = std::get<wire::ServerMessage>(received);
            if (const auto* answer = std::get_if<wire::Accepted>(&message); answer != nullptr && answer->request == request) {
                accepted.push_back(ms);
                is_accepted = true;
            }
            if (const auto* told = std::get_if<wire::Applied>(&message); told != nullptr && told->request == request) {
                if (told->error) throw std::runtime_error("a change is not taken: " + told->error->text());
                applied.push_back(ms);
                applied_before = told->step;
                m_line.send(wire::Acknowledge{m_session, told->seq});
            }
        }
    }
    void flip(const Flip& flip) {
        const std::string request = wire::new_request_id();
        const Clock::time_point sent = Clock::now();
        m_line.send(wire::MakeChange{request, m_session, flip});
        m_line.accepted(request);
        flip_accepted.push_back(ms_since(sent));
        const auto told = m_line.until<wire::Flipped>([&](const wire::Flipped& end) { return end.request == request; });
        flipped.push_back(ms_since(sent));
        flips_done += told.done ? 1 : 0;
        m_line.send(wire::Acknowledge{m_session, told.seq});
    }

    std::vector<double> accepted, applied, shown, flip_accepted, flipped;
    std::size_t flips_done = 0;

  private:
    Line m_line;
    std::uint64_t m_session = 0;
};

/// A crossing near the middle that may flip, to its other side.
Flip middle_flip(const std::string& document) {
    const BlockPtr cloth = evaluate(must(read_document(document), "the design"))->block;
    Flip wish{cloth->picks() / 2, cloth->ends() / 2, false};
    while (!flip(stack_at(*cloth, wish.pick, wish.end), wish.pick, wish.end)) ++wish.pick;
    wish.weft_over = !cloth->weft_over(wish.pick, wish.end);
    return wish;
}

/// Cancels jobs at moments of their work: until job_ended.
std::vector<double> cancel_jobs(const SimdBox& box, const std::string& document, std::size_t count) {
    constexpr std::chrono::milliseconds between_looks{20};
    constexpr std::chrono::minutes most{5};
    Line line(box.place());
    std::vector<double> ms;
    for (std::size_t k = 0; k < count; ++k) {
        const std::string submitted = wire::new_request_id(), request = wire::new_request_id();
        line.send(wire::Submit{submitted, document, restless(), {}});
        const std::uint64_t job = line.accepted(submitted).job.value();
        const auto begun = [&] {
            const Json status = box.status();
            for (const Json& one : status.at("jobs"))
                if (one.at("job") == job) return one.at("step").get<std::uint64_t>() > 0;
            const auto ended = line.until<wire::JobEnded>([&](const wire::JobEnded& end) { return end.job == job; });
            throw std::runtime_error("a job ended by itself: " + (ended.error ? ended.error->text() : ended.report.value("ending", "")));
        };
        for (const auto late = Clock::now() + most; !begun(); std::this_thread::sleep_for(between_looks))
            if (Clock::now() > late) throw std::runtime_error("a job does not begin for minutes: " + box.status().dump());
        hesitate();
        const Clock::time_point sent = Clock::now();
        line.send(wire::Cancel{request, job});
        line.until<wire::JobEnded>([&](const wire::JobEnded& ended) { return ended.job == job; });
        ms.push_back(ms_since(sent));
        line.send(wire::AcknowledgeJob{job});
    }
    return ms;
}

Json flip_to_and_fro(const SimdBox& box, const std::string& document, std::size_t count) {
    wire::Simulation simulation = restless();
    simulation.residual.reset();  // a flip ends with the rest that follows it
    Subject subject(box.place(), document, simulation);
    Flip flip = middle_flip(document);
    for (std::size_t k = 0; k < count; ++k, flip.weft_over = !flip.weft_over) {
        hesitate();
        subject.flip(flip);
    }
    return {{"accepted", spread_ms(subject.flip_accepted)}, {"flipped", spread_ms(subject.flipped)}, {"done", subject.flips_done}};
}

Json measured(const SimdBox& box, const LatencyWish& wish, std::size_t points, const CommandOutcome& outcome) {
    const TiledCloth cloth = tiled_cloth(points);
    Json told{{"points", cloth.points}};
    for (const bool is_local : {false, true}) {
        outcome.note(std::to_string(cloth.points) + " points, " + (is_local ? "Unix socket" : "TCP") + ": changes");
        Subject subject(is_local ? box.place() : box.place_of_person(0), cloth.document, restless());
        for (std::size_t k = 0; k < wish.changes; ++k) {
            hesitate();
            subject.change(k);
        }
        Json& one = told[is_local ? "unix" : "tcp"];
        one = {{"accepted", spread_ms(subject.accepted)}, {"applied", spread_ms(subject.applied)}, {"shown", spread_ms(subject.shown)}};
    }
    outcome.note(std::to_string(cloth.points) + " points: flips");
    told["flip"] = flip_to_and_fro(box, cloth.document, wish.flips);
    outcome.note(std::to_string(cloth.points) + " points: jobs cancelled");
    told["cancel"] = {{"ended", spread_ms(cancel_jobs(box, cloth.document, wish.cancels))}};
    return told;
}

std::string spread_text(const Json& spread) {
    return "p50 " + form("%.1f", spread.at("p50_ms")) + ", p99 " + form("%.1f", spread.at("p99_ms")) + ", most " + form("%.1f ms", spread.at("max_ms")) +
           " (" + std::to_string(spread.at("count").get<std::size_t>()) + ")";
}

void tell(AimTable& table, const Json& size) {
    constexpr double most_accepted_ms = 50, most_cancel_ms = 250;
    const std::string points = std::to_string(size.at("points").get<std::size_t>()) + " points, ";
    const auto within = [](const Json& spread, double most) { return spread.at("p99_ms").get<double>() <= most; };
    for (const auto& [way, name] : {std::pair{"tcp", "TCP"}, std::pair{"unix", "Unix socket"}}) {
        const Json& spreads = size.at(way);
        const std::string what = points + name + ": change to ";
        table.row(what + "`accepted`", spread_text(spreads.at("accepted")), "p99 50 ms", within(spreads.at("accepted"), most_accepted_ms));
        table.row(what + "`applied`", spread_text(spreads.at("applied")));
        table.row(what + "the first frame that shows it", spread_text(spreads.at("shown")));
    }
    const Json& flip = size.at("flip");
    table.row(points + "flip to `accepted`", spread_text(flip.at("accepted")), "p99 50 ms", within(flip.at("accepted"), most_accepted_ms));
    table.row(points + "flip to `flipped`", spread_text(flip.at("flipped")));
    table.row(points + "cancel to `job_ended`", spread_text(size.at("cancel").at("ended")), "p99 250 ms", within(size.at("cancel").at("ended"), most_cancel_ms));
}

Status latency(const LatencyWish& wish, CommandOutcome& outcome) {
    Json told{{"before", circumstances()}, {"sizes", Json::array()}};
    for (const std::size_t points : wish.points) told["sizes"].push_back(measured(SimdBox(wish.threads, 1), wish, points, outcome));
    told["after"] = circumstances();
    AimTable table("simd-latency: " + told_circumstances(told.at("before"), told.at("after")));
    for (const Json& size : told.at("sizes")) tell(table, size);
    outcome.answer(told, table.text());
    return {};
}

}  // namespace

void add_simd_latency(CLI::App& app, CommandOutcome& outcome) {
    CLI::App* const command = add_command(app, outcome, "simd-latency", "How soon simd answers, does and shows what a client asks for",
                                          "tools/bench simd-latency --changes 100 --points 2000");
    auto wish = std::make_shared<LatencyWish>();
    command->add_option("--points", wish->points, "control points of the cloths (2000 and 20000); may be repeated")->check(CLI::Range(1, 1'000'000));
    command->add_option("--changes", wish->changes, "changes of each size on each way (100)")->check(CLI::Range(1, 100'000));
    command->add_option("--flips", wish->flips, "flips of each size (20)")->check(CLI::Range(1, 100'000));
    command->add_option("--cancels", wish->cancels, "cancelled jobs of each size (30)")->check(CLI::Range(1, 100'000));
    command->add_option("--threads", wish->threads, "threads of simd that compute; 0: one a core")->check(CLI::Range(0, 1024));
    on_run(command, outcome, [wish, &outcome] { return latency(*wish, outcome); });
}

}  // namespace weave::bench
