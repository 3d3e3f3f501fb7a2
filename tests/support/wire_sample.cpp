// What tests/wire/follow needs of C++: records what a server would send, and compares what another program made of it.
//   wire_sample record FILE           a session of 40 frames
//   wire_sample compare FILE SEEN     SEEN is what follow.py printed; ends with 1 where it is not what C++ reads
//   wire_sample size FILE.yarns...    bytes a point as a frame, and the greatest error in radii (libweave/weave/wire/README.md)

#include <weave/core/file.hpp>
#include <weave/sim/yarns_file.hpp>
#include <weave/wire/frame.hpp>
#include <weave/wire/message.hpp>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <random>
#include <string>
#include <vector>

using namespace weave;
using namespace weave::wire;

namespace {

/// Ends the program where something is not as it must be.
void must(bool holds, const std::string& what) {
    if (holds) return;
    std::fprintf(stderr, "wire_sample: %s\n", what.c_str());
    std::exit(1);
}

template <class T>
T taken(Result<T> result) {
    must(static_cast<bool>(result), result ? "" : result.error().text());
    return std::move(result).value();
}

std::string read_all(const std::string& path) {
    return taken(read_file(path));
}

// ---- Recording ----

struct Recording {
    std::string bytes;

    void add(char kind, const std::string& payload) {
        bytes += kind;
        for (int k = 0; k < 4; ++k) bytes += static_cast<char>(payload.size() >> (8 * k) & 0xff);
        bytes += payload;
    }
    void say(const ServerMessage& message) { add('t', write_message(message)); }
};

constexpr std::uint64_t session = 7;

Layout layout_of(std::uint64_t number, std::uint64_t seq, const std::vector<std::uint32_t>& counts) {
    Layout layout;
    layout.session = session, layout.seq = seq, layout.layout = number;
    for (const std::uint32_t count : counts) {
        LayoutYarn& yarn = layout.yarns.emplace_back();
        yarn.number = layout.yarns.size() - 1;
        yarn.points = count;
    }
    return layout;
}

Frame frame_of(std::mt19937_64& engine, std::uint64_t number, std::uint64_t layout, const std::vector<std::uint32_t>& counts) {
    std::uniform_real_distribution<double> between(-1, 1);
    Frame frame;
    frame.head.session = session, frame.head.number = number, frame.head.step = 10 * number;
    frame.head.residual = std::exp(10 * between(engine));
    frame.head.layout = static_cast<std::uint32_t>(layout);
    if (number % 3 == 0) frame.head.lost_crossings = static_cast<std::uint32_t>(number);
    frame.head.size_mm = {10 + between(engine), 20 + between(engine)};
    frame.head.quantum_mm = quantum_for(0.1 + 0.01 * between(engine));
    frame.head.at_rest = number % 2 == 0, frame.head.is_last = number % 5 == 0;
    frame.head.is_coarse = layout == 1, frame.head.is_flipping = number % 7 == 0;
    frame.counts = counts;
    const double reach = std::exp(15 * between(engine));  // from microns to kilometres
    for (std::size_t i = 0; i < counts.size(); ++i)
        for (std::uint32_t k = 0; k < counts[i]; ++k)
            frame.points.emplace_back(reach * (0.1 * k + between(engine)), reach * static_cast<double>(i), reach * between(engine));
    return frame;
}

void record(const std::string& path) {
    std::mt19937_64 engine(1);
    const std::vector<std::uint32_t> coarse{5, 1, 130}, fine{20, 3, 520, 64};
    Recording recording;
    recording.say(Welcome{1, "wire_sample", {}});
    recording.say(Accepted{"follow-1", {}, {}, {}});
    recording.say(SessionList{"follow-2", {{session, "shoe", Phase::running, 0, {}, 136, 1, false, {}}}});
    recording.say(layout_of(1, 1, coarse));
    recording.say(PhaseChanged{session, 2, 0, Phase::running});
    for (std::uint64_t number = 1; number <= 40; ++number) {
        if (number == 20) recording.say(layout_of(2, 3, fine));
        if (number == 25) recording.say(Applied{session, 4, 250, "somebody-else", Flip{3, 4, true}, {}});
        if (number == 28) recording.say(Flipped{session, 5, 280, "somebody-else", false, "ends „in the way“"});
        if (number % 4 != 3) recording.add('b', taken(encode_frame(frame_of(engine, number, number < 20 ? 1 : 2, number < 20 ? coarse : fine))));
    }
    recording.say(Ended{session, 6, 400, Why::closed, {}, {{"converged", true}}});
    const auto status = write_file(path, recording.bytes);
    must(static_cast<bool>(status), status ? "" : status.error().text());
}

// ---- Comparing ----

Json json_of(const Frame& frame) {
    const FrameHead& head = frame.head;
    Json yarns = Json::array();
    std::size_t at = 0;
    for (const std::uint32_t count : frame.counts) {
        Json& yarn = yarns.emplace_back(Json::array());
        for (std::uint32_t k = 0; k < count; ++k, ++at)
            yarn.push_back({frame.points[at].x(), frame.points[at].y(), frame.points[at].z()});
    }
    return {{"session", head.session}, {"frame", head.number}, {"step", head.step}, {"residual", head.residual},
            {"quantum_mm", head.quantum_mm}, {"size_mm", head.size_mm}, {"layout", head.layout},
            {"lost_crossings", head.lost_crossings ? Json(*head.lost_crossings) : Json(nullptr)},
            {"at_rest", head.at_rest}, {"last", head.is_last}, {"coarse", head.is_coarse}, {"flipping", head.is_flipping},
            {"yarns", std::move(yarns)}};
}

/// What follow.py should have seen, but for what it sends.
Json seen_here(const std::string& recording) {
    Json frames = Json::array(), events = Json::array();
    std::uint64_t last = 0, missed = 0;
    for (std::size_t at = 0; at < recording.size();) {
        std::size_t length = 0;
        for (std::size_t k = 0; k < 4; ++k) length |= std::size_t{static_cast<std::uint8_t>(recording[at + 1 + k])} << (8 * k);
        const std::string payload = recording.substr(at + 5, length);
        if (recording[at] == 'b') {
            const Frame frame = taken(decode_frame(payload));
            missed += frame.head.number - last - 1;
            last = frame.head.number;
            frames.push_back(json_of(frame));
        } else if (Json message = taken(parse_json(payload)); message.contains("seq")) {
            events.push_back(std::move(message));
        }
        at += 5 + length;
    }
    return {{"frames", std::move(frames)}, {"events", std::move(events)}, {"missed", missed}};
}

void compare(const std::string& recording, const std::string& seen_file) {
    Json seen = taken(parse_json(read_all(seen_file)));
    must(seen.contains("sent") && seen["sent"].size() >= 3, "the follower says nothing");
    for (const Json& line : seen["sent"]) static_cast<void>(taken(read_client_message(line.get<std::string>())));
    seen.erase("sent");
    const Json here = seen_here(read_all(recording));
    must(here["frames"].size() == 30 && here["events"].size() == 6, "the recording is not whole");
    must(canonical_json(here) == canonical_json(seen), "the follower saw other numbers");
}

// ---- Sizes ----

void tell_size(const std::string& path) {
    const Yarns yarns = taken(read_yarns(read_all(path)));
    Frame frame;
    double radius = 1e9;
    for (const SimulatedYarn& yarn : yarns.yarns) {
        radius = std::min(radius, yarn.radius_mm);
        frame.counts.push_back(static_cast<std::uint32_t>(yarn.spline.control.size()));
        frame.points.insert(frame.points.end(), yarn.spline.control.begin(), yarn.spline.control.end());
    }
    frame.head.quantum_mm = quantum_for(radius);
    const std::string bytes = taken(encode_frame(frame));
    const Frame again = taken(decode_frame(bytes));
    double off = 0;
    for (std::size_t i = 0; i < frame.points.size(); ++i) off = std::max(off, (again.points[i] - frame.points[i]).norm());
    const auto points = static_cast<double>(frame.points.size());
    std::printf("%s: %zu yarns, %zu points, %zu bytes, %.2f a point; greatest error 1/%.0f of the smallest radius\n", path.c_str(),
                frame.counts.size(), frame.points.size(), bytes.size(), static_cast<double>(bytes.size()) / points, radius / off);
}

}  // namespace

int main(int count, char** words) {
    const std::vector<std::string> given(words + 1, words + count);
    if (given.size() == 2 && given[0] == "record") {
        record(given[1]);
    } else if (given.size() == 3 && given[0] == "compare") {
        compare(given[1], given[2]);
    } else if (given.size() >= 2 && given[0] == "size") {
        for (std::size_t i = 1; i < given.size(); ++i) tell_size(given[i]);
    } else {
        must(false, "record FILE, compare FILE SEEN or size FILE.yarns...");
    }
    return 0;
}
