#include <weave/wire/frame.hpp>

#include <bit>
#include <cmath>
#include <limits>
#include <numeric>
#include <type_traits>

namespace weave::wire {

namespace {

constexpr std::string_view magic = "WVFR";
constexpr std::uint32_t not_looked = std::numeric_limits<std::uint32_t>::max();
constexpr std::uint16_t flag_at_rest = 1, flag_last = 2, flag_coarse = 4, flag_flipping = 8, all_flags = 15;
constexpr double least_quantum_mm = 1e-12, most_quantum_mm = 1e6;
/// Places in quanta lie below it, so that a second difference of three has 49 bits with its sign.
constexpr std::int64_t place_end = std::int64_t{1} << 46;
constexpr std::size_t longest_varint = 7;
constexpr std::size_t least_point_bytes = 3, least_yarn_bytes = 1 + least_point_bytes;
constexpr const char* axis_names = "xyz";

std::string yarn_place(std::size_t yarn) {
    return "yarns[" + std::to_string(yarn) + "]";
}

std::string point_place(std::size_t yarn, std::size_t point, std::size_t axis) {
    return yarn_place(yarn) + ".points[" + std::to_string(point) + "]." + axis_names[axis];
}

// ---- What both ways hold to ----

Status check_number(std::uint64_t value, std::uint64_t least, const char* name) {
    if (value >= least && value <= most_number) return {};
    return bad_input("must be from " + std::to_string(least) + " to " + std::to_string(most_number), name);
}

/// -0 is refused: a frame has one sequence of bytes.
Status check_amount(double value, double most, const char* name) {
    if (value >= 0 && value <= most && !std::signbit(value)) return {};
    return bad_input("must be a finite number from 0 on, within its limit", name);
}

Status check_head(const FrameHead& head) {
    WEAVE_CHECK_OK(check_number(head.session, 1, "session"));
    WEAVE_CHECK_OK(check_number(head.number, 1, "number"));
    WEAVE_CHECK_OK(check_number(head.step, 0, "step"));
    WEAVE_CHECK_OK(check_amount(head.residual, std::numeric_limits<double>::max(), "residual"));
    if (head.lost_crossings == not_looked) return bad_input("must be below 2^32 - 1", "lost_crossings");
    if (head.layout == 0) return bad_input("must be from 1 on", "layout");
    WEAVE_CHECK_OK(check_amount(head.size_mm[0], farthest_mm, "size_mm[0]"));
    WEAVE_CHECK_OK(check_amount(head.size_mm[1], farthest_mm, "size_mm[1]"));
    if (head.quantum_mm >= least_quantum_mm && head.quantum_mm <= most_quantum_mm) return {};
    return bad_input("must be from 1e-12 to 1e6 mm", "quantum_mm");
}

// ---- Prediction ----

using Quanta = std::array<std::int64_t, 3>;

/// What the next point of a yarn is expected to be: on a straight line with the two before it. The first is
/// expected at the origin, the second where the first is.
class Prediction {
  public:
    [[nodiscard]] std::int64_t at(std::size_t axis) const {
        return m_seen < 2 ? m_last[axis] : 2 * m_last[axis] - m_before[axis];
    }
    void learn(const Quanta& point) {
        m_before = m_last;
        m_last = point;
        ++m_seen;
    }

  private:
    Quanta m_last{}, m_before{};
    std::size_t m_seen = 0;
};

/// Small numbers of either sign as small numbers: 0, -1, 1, -2 … are 0, 1, 2, 3 …
std::uint64_t zigzag(std::int64_t value) {
    return (static_cast<std::uint64_t>(value) << 1) ^ (value < 0 ? ~std::uint64_t{0} : 0);
}
std::int64_t unzigzag(std::uint64_t value) {
    return static_cast<std::int64_t>(value >> 1) ^ -static_cast<std::int64_t>(value & 1);
}

// ---- Writing ----

class Writer {
  public:
    template <class T>
    void fixed(T value) {
        if constexpr (std::is_same_v<T, double>) {
            fixed(std::bit_cast<std::uint64_t>(value));
        } else {
            for (std::size_t i = 0; i < sizeof(T); ++i)
                m_bytes.push_back(static_cast<char>(static_cast<std::uint64_t>(value) >> (8 * i) & 0xff));
        }
    }
    void varint(std::uint64_t value) {
        for (; value >= 0x80; value >>= 7) m_bytes.push_back(static_cast<char>((value & 0x7f) | 0x80));
        m_bytes.push_back(static_cast<char>(value));
    }
    void text(std::string_view text) { m_bytes += text; }
    void reserve(std::size_t size) { m_bytes.reserve(size); }
    [[nodiscard]] std::size_t size() const { return m_bytes.size(); }
    [[nodiscard]] std::string take() && { return std::move(m_bytes); }

  private:
    std::string m_bytes;
};

std::uint16_t flags_of(const FrameHead& head) {
    return static_cast<std::uint16_t>((head.at_rest ? flag_at_rest : 0) | (head.is_last ? flag_last : 0) |
                                      (head.is_coarse ? flag_coarse : 0) | (head.is_flipping ? flag_flipping : 0));
}

void write_head(Writer& writer, const Frame& frame) {
    const FrameHead& head = frame.head;
    writer.text(magic);
    writer.fixed(frame_version);
    writer.fixed(flags_of(head));
    writer.fixed(head.session);
    writer.fixed(head.number);
    writer.fixed(head.step);
    writer.fixed(head.residual);
    writer.fixed(head.quantum_mm);
    writer.fixed(head.size_mm[0]);
    writer.fixed(head.size_mm[1]);
    writer.fixed(head.layout);
    writer.fixed(head.lost_crossings.value_or(not_looked));
    writer.fixed(static_cast<std::uint32_t>(frame.counts.size()));
    writer.fixed(static_cast<std::uint32_t>(frame.points.size()));
}

/// A place in quanta; nothing where it cannot be told.
std::optional<std::int64_t> quanta_of(double mm, double quantum_mm) {
    const double quanta = std::round(mm / quantum_mm);
    if (!(std::abs(quanta) < static_cast<double>(place_end)) || !(std::abs(quanta * quantum_mm) <= farthest_mm)) return {};
    return static_cast<std::int64_t>(quanta);
}

Status write_yarn(Writer& writer, const Frame& frame, std::size_t yarn, std::size_t first) {
    writer.varint(frame.counts[yarn]);
    Prediction prediction;
    for (std::size_t i = 0; i < frame.counts[yarn]; ++i) {
        Quanta point{};
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const double mm = frame.points[first + i][static_cast<Eigen::Index>(axis)];
            const auto quanta = quanta_of(mm, frame.head.quantum_mm);
            if (!quanta) return bad_input("is not a place that a frame can tell", point_place(yarn, i, axis));
            point[axis] = *quanta;
            writer.varint(zigzag(*quanta - prediction.at(axis)));
        }
        prediction.learn(point);
        if (writer.size() > most_frame_bytes) return bad_input("is beyond the longest frame, 64 MiB", yarn_place(yarn));
    }
    return {};
}

Status check_counts(const Frame& frame) {
    if (frame.points.size() > most_frame_bytes / least_point_bytes || frame.counts.size() > frame.points.size())
        return bad_input("are more than a frame can hold", "yarns");
    std::size_t points = 0;
    for (std::size_t yarn = 0; yarn < frame.counts.size(); ++yarn) {
        if (frame.counts[yarn] == 0) return bad_input("has no points", yarn_place(yarn));
        points += frame.counts[yarn];
    }
    if (points != frame.points.size()) return bad_input("must have as many points as are counted", "yarns");
    return {};
}

// ---- Reading ----

class Reader {
  public:
    explicit Reader(std::string_view bytes) : m_bytes(bytes) {}

    /// The head is there: its length was checked.
    template <class T>
    T fixed() {
        std::uint64_t value = 0;
        for (std::size_t i = 0; i < sizeof(T); ++i) value |= std::uint64_t{byte()} << (8 * i);
        if constexpr (std::is_same_v<T, double>) {
            return std::bit_cast<double>(value);
        } else {
            return static_cast<T>(value);
        }
    }
    /// A number in as few bytes as it needs, at most seven; nothing otherwise.
    std::optional<std::uint64_t> varint() {
        std::uint64_t value = 0;
        for (std::size_t i = 0; i < longest_varint && m_at < m_bytes.size(); ++i) {
            const std::uint8_t next = byte();
            value |= std::uint64_t{next & 0x7fU} << (7 * i);
            if (next >= 0x80) continue;
            if (next == 0 && i > 0) return {};
            return value;
        }
        return {};
    }
    [[nodiscard]] std::size_t at() const { return m_at; }
    [[nodiscard]] std::size_t left() const { return m_bytes.size() - m_at; }

  private:
    std::uint8_t byte() { return static_cast<std::uint8_t>(m_bytes[m_at++]); }

    std::string_view m_bytes;
    std::size_t m_at = 0;
};

Error no_varint(std::size_t at, std::string where) {
    return bad_input("is no number in as few bytes as it needs, at byte " + std::to_string(at), std::move(where));
}

Status check_start(std::string_view bytes) {
    if (bytes.size() > most_frame_bytes) return bad_input("is longer than 64 MiB", "frame");
    if (bytes.size() < frame_head_bytes) return bad_input("is shorter than its head of 80 bytes", "frame");
    if (!bytes.starts_with(magic)) return bad_input("does not begin with WVFR: this is no frame", "frame");
    return {};
}

Status read_version(Reader& reader) {
    static_cast<void>(reader.fixed<std::uint32_t>());  // the magic
    const auto version = reader.fixed<std::uint16_t>();
    if (version == frame_version) return {};
    return bad_input("is " + std::to_string(version) + "; known here is version " + std::to_string(frame_version),
                     "version");
}

Status read_flags(Reader& reader, FrameHead& head) {
    const auto flags = reader.fixed<std::uint16_t>();
    if ((flags & ~all_flags) != 0) return bad_input("has bits that are not known here", "flags");
    head.at_rest = (flags & flag_at_rest) != 0;
    head.is_last = (flags & flag_last) != 0;
    head.is_coarse = (flags & flag_coarse) != 0;
    head.is_flipping = (flags & flag_flipping) != 0;
    return {};
}

Result<FrameHead> read_head(Reader& reader) {
    FrameHead head;
    WEAVE_CHECK_OK(read_version(reader));
    WEAVE_CHECK_OK(read_flags(reader, head));
    head.session = reader.fixed<std::uint64_t>();
    head.number = reader.fixed<std::uint64_t>();
    head.step = reader.fixed<std::uint64_t>();
    head.residual = reader.fixed<double>();
    head.quantum_mm = reader.fixed<double>();
    head.size_mm[0] = reader.fixed<double>();
    head.size_mm[1] = reader.fixed<double>();
    head.layout = reader.fixed<std::uint32_t>();
    const auto lost = reader.fixed<std::uint32_t>();
    if (lost != not_looked) head.lost_crossings = lost;
    WEAVE_CHECK_OK(check_head(head));
    return head;
}

Result<Vec3> read_point(Reader& reader, Prediction& prediction, double quantum_mm, std::size_t yarn, std::size_t point) {
    Quanta quanta{};
    Vec3 place;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const std::size_t at = reader.at();
        const auto written = reader.varint();
        if (!written) return no_varint(at, point_place(yarn, point, axis));
        quanta[axis] = prediction.at(axis) + unzigzag(*written);
        const double mm = static_cast<double>(quanta[axis]) * quantum_mm;
        if (std::abs(quanta[axis]) >= place_end || !(std::abs(mm) <= farthest_mm))
            return bad_input("lies too far away, at byte " + std::to_string(at), point_place(yarn, point, axis));
        place[static_cast<Eigen::Index>(axis)] = mm;
    }
    prediction.learn(quanta);
    return place;
}

/// Reads one yarn of a frame that still lacks `room` points.
Status read_yarn(Reader& reader, Frame& frame, std::size_t room) {
    const std::size_t yarn = frame.counts.size(), at = reader.at();
    const auto count = reader.varint();
    if (!count) return no_varint(at, yarn_place(yarn));
    if (*count == 0) return bad_input("has no points, at byte " + std::to_string(at), yarn_place(yarn));
    if (*count > room)
        return bad_input("has " + std::to_string(*count) + " points where " + std::to_string(room) +
                             " are left of those in the head, at byte " + std::to_string(at), yarn_place(yarn));
    frame.counts.push_back(static_cast<std::uint32_t>(*count));
    Prediction prediction;
    for (std::size_t i = 0; i < *count; ++i) {
        WEAVE_TRY(frame.points.emplace_back(), read_point(reader, prediction, frame.head.quantum_mm, yarn, i));
    }
    return {};
}

}  // namespace

double quantum_for(double smallest_radius_mm) {
    return smallest_radius_mm / 50;  // rounding errs by half of it along each axis, 0.87 of it in space
}

Result<std::string> encode_frame(const Frame& frame) {
    WEAVE_CHECK_OK(check_head(frame.head));
    WEAVE_CHECK_OK(check_counts(frame));
    Writer writer;
    writer.reserve(frame_head_bytes + frame.counts.size() + 4 * frame.points.size());
    write_head(writer, frame);
    std::size_t first = 0;
    for (std::size_t yarn = 0; yarn < frame.counts.size(); ++yarn) {
        WEAVE_CHECK_OK(write_yarn(writer, frame, yarn, first));
        first += frame.counts[yarn];
    }
    return std::move(writer).take();
}

Result<Frame> decode_frame(std::string_view bytes) {
    WEAVE_CHECK_OK(check_start(bytes));
    Reader reader(bytes);
    Frame frame;
    WEAVE_TRY(frame.head, read_head(reader));
    const auto yarns = reader.fixed<std::uint32_t>(), points = reader.fixed<std::uint32_t>();
    if (yarns > reader.left() / least_yarn_bytes) return bad_input("are more than the bytes can hold", "yarns");
    if (points > (reader.left() - yarns) / least_point_bytes || points < yarns)
        return bad_input("are more than the bytes can hold, or fewer than one a yarn", "points");
    frame.counts.reserve(yarns);
    frame.points.reserve(points);
    for (std::size_t yarn = 0; yarn < yarns; ++yarn) WEAVE_CHECK_OK(read_yarn(reader, frame, points - frame.points.size()));
    if (frame.points.size() != points) return bad_input("are fewer than its head counts", "points");
    if (reader.left() > 0)
        return bad_input("has bytes behind its last yarn, from byte " + std::to_string(reader.at()), "frame");
    return frame;
}

}  // namespace weave::wire
