#include "simd.hpp"
#include "simd_box.hpp"
#include "table.hpp"

#include <weave/design/document.hpp>
#include <weave/samples/samples.hpp>
#include <weave/sim/yarns_file.hpp>
#include <weave/wire/follower.hpp>

#include <algorithm>
#include <functional>
#include <memory>

namespace weave::bench {

namespace {

constexpr std::chrono::minutes patience{5};
constexpr std::size_t pauses = 10;

struct FramesWish {
    std::vector<std::string> samples{"satin-e", "twill-g", "layer-to-layer", "angle-interlock-b", "tl013-corrected"};
};

/// What frames of one kind take, and how far they are off.
struct Frames {
    std::size_t count = 0;
    double bytes = 0, points = 0, error_radii = 0;

    void take(const wire::Frame& frame) {
        ++count;
        bytes += static_cast<double>(must(wire::encode_frame(frame), "a frame").size());  // the bytes that came: a frame has one form
        points += static_cast<double>(frame.points.size());
    }
    /// How far its points lie from the yarns themselves, in radii of their yarn.
    void compare(const wire::Frame& frame, const Yarns& yarns) {
        std::size_t at = 0;
        if (frame.counts.size() != yarns.yarns.size()) throw std::runtime_error("a frame has other yarns than its session");
        for (std::size_t y = 0; y < frame.counts.size(); ++y) {
            const auto& control = yarns.yarns[y].spline.control;
            if (control.size() != frame.counts[y]) throw std::runtime_error("a frame has other points than its session");
            for (const Vec3& point : control) error_radii = std::max(error_radii, (frame.points[at++] - point).norm() / yarns.yarns[y].radius_mm);
        }
    }
    [[nodiscard]] Json told() const {
        return {{"frames", count}, {"points", points / static_cast<double>(count)}, {"bytes_a_frame", bytes / static_cast<double>(count)},
                {"bytes_a_point", bytes / points}, {"greatest_error_radii", error_radii}};
    }
};

class Looker {
  public:
    Looker(const SimdBox& box, const std::string& sample) : m_follower(must(wire::Follower::connect(box.place(), "bench", patience), "no connection")) {
        wire::Simulation simulation;
        simulation.plan.reduce = false;
        m_session = must(m_follower.create(write_document(find_sample(sample)->make()), simulation, patience), "a session").session.value();
        ask(wire::WantFrames{wire::new_request_id(), m_session, 1000});
    }
    /// Runs to rest, with some stops on the way.
    Json measure() {
        Frames moving, resting;
        for (std::size_t k = 0; k < pauses && !m_rests; ++k) {
            const std::uint64_t steps = 3 * (k + 1);
            ask(wire::Step{wire::new_request_id(), m_session, steps});
            const wire::Frame last = until_last(moving, m_newest ? m_newest->head.step + steps : steps);
            if (!m_rests) moving.compare(last, yarns());
        }
        while (!m_rests) {
            ask(wire::Run{wire::new_request_id(), m_session});
            until_last(moving, m_newest ? m_newest->head.step + 1 : 1);
        }
        const wire::Frame last = *m_newest;
        resting.take(last);
        resting.compare(last, yarns());
        ask(wire::Close{wire::new_request_id(), m_session});
        return {{"moving", moving.told()}, {"resting", resting.told()}};
    }

  private:
    void ask(const wire::ClientMessage& message) { must(wire::answer_of<wire::Accepted>(m_follower.ask(message, patience)), "simd refuses"); }
    /// Takes frames until one is the last, at rest or at this step; those before it are counted. One that shows an earlier
    /// stop again is none: the cloth has moved on.
    wire::Frame until_last(Frames& counted, std::uint64_t step) {
        while (true) {
            const auto received = must(m_follower.receive(patience), "the connection");
            if (!received) throw std::runtime_error("simd says nothing for minutes");
            const auto* frame = std::get_if<wire::Frame>(&*received);
            if (frame == nullptr || frame->head.step == 0) continue;
            m_newest = *frame;
            m_rests = frame->head.at_rest;
            if (!m_rests) counted.take(*frame);
            if (frame->head.is_last && (m_rests || frame->head.step >= step)) return *frame;
        }
    }
    Yarns yarns() {
        return must(read_yarns(must(m_follower.download(wire::session_yarns(m_session), std::uint64_t{1} << 30), "the yarns")), "the yarns");
    }

    wire::Follower m_follower;
    std::uint64_t m_session = 0;
    std::optional<wire::Frame> m_newest;
    bool m_rests = false;
};

std::string words_of(const Json& said) {
    constexpr double most_bytes = 7, most_error = 1.0 / 50;
    AimTable table("simd-frames: " + told_circumstances(said.at("before"), said.at("after")));
    for (const Json& sample : said.at("samples")) {
        for (const char* kind : {"moving", "resting"}) {
            const Json& frames = sample.at(kind);
            const double bytes = frames.at("bytes_a_point"), error = frames.at("greatest_error_radii");
            table.row(sample.at("name").get<std::string>() + (kind == std::string("moving") ? ", in motion (" : ", at rest (") + form("%.0f points, ", frames.at("points")) +
                          form("%.0f frames): bytes a point, greatest error", frames.at("frames")),
                      form("%.2f, ", bytes) + form("1/%.0f of a radius", 1 / std::max(error, 1e-9)), "under 7 at 1/50", bytes < most_bytes && error <= most_error);
        }
    }
    return table.text();
}

Status frames(const FramesWish& wish, CommandOutcome& outcome) {
    Json said{{"before", circumstances()}, {"samples", Json::array()}};
    for (const std::string& name : wish.samples)
        if (find_sample(name) == nullptr) return Error{ErrorCode::usage, "there is no sample '" + name + "'", "--sample"};
    const SimdBox box(0);
    for (const std::string& name : wish.samples) {
        outcome.note(name);
        Json one = Looker(box, name).measure();
        one["name"] = name;
        said["samples"].push_back(std::move(one));
    }
    said["after"] = circumstances();
    outcome.answer(said, words_of(said));
    return {};
}

}  // namespace

void add_simd_frames(CLI::App& app, CommandOutcome& outcome) {
    CLI::App* const command = add_command(app, outcome, "simd-frames", "Size of frames, in motion and at rest, and how far they are off the yarns",
                                          "tools/bench simd-frames --sample satin-e");
    auto wish = std::make_shared<FramesWish>();
    command->add_option("--sample", wish->samples, "the samples (satin-e, twill-g, layer-to-layer, angle-interlock-b, tl013-corrected); may be repeated");
    on_run(command, outcome, [wish, &outcome] { return frames(*wish, outcome); });
}

}  // namespace weave::bench
