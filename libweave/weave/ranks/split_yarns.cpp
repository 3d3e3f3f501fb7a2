#include <weave/ranks/split_yarns.hpp>

#include <weave/core/file.hpp>
#include <weave/design/document.hpp>
#include <weave/sim/order.hpp>
#include <weave/sim/planned_yarns.hpp>
#include <weave/sim/result.hpp>
#include <weave/sim/yarns_file.hpp>

#include <algorithm>
#include <cmath>
#include <utility>

namespace weave::ranks {

namespace {

/// Whether one of these parts has a point; which.
std::optional<std::size_t> part_with(const std::vector<Part>& parts, std::uint32_t yarn, std::uint32_t index) {
    for (std::size_t b = 0; b < parts.size(); ++b) {
        const auto at = std::lower_bound(parts[b].own.begin(), parts[b].own.end(), std::pair(yarn, index), [](const Point& point, const auto& wanted) {
            return std::pair(point.yarn, point.index) < wanted;
        });
        if (at != parts[b].own.end() && at->yarn == yarn && at->index == index) return b;
    }
    return {};
}

double points_per_key_of(const sim::PlanInStretches& plan, std::size_t yarn) {
    const std::size_t open = plan.plan().scene.yarns[yarn].is_periodic ? 0 : 1, keys = plan.keys(yarn) - open, segments = plan.points(yarn) - open;
    return keys > 0 ? static_cast<double>(segments) / static_cast<double>(keys) : 0;
}

/// The strand of a piece that holds a yarn at a parameter, as it lies in the cloth itself.
std::optional<std::size_t> strand_at(const Piece& piece, std::uint32_t yarn, double at) {
    for (std::size_t s = 0; s < piece.strands().size(); ++s) {
        const Piece::Strand& strand = piece.strands()[s];
        const double first = static_cast<double>(strand.first);
        if (strand.yarn == yarn && strand.image == std::array<std::int16_t, 2>{} && at >= first &&
            at <= first + piece.fabric().yarns()[s].points - 1)
            return s;
    }
    return {};
}

sim::OrderSubject subject_of(const Piece& piece, const Outline& outline) {
    sim::OrderSubject subject;
    const std::vector<std::vector<Vec3>> now = piece.fabric().control(piece.state);
    for (std::size_t s = 0; s < now.size(); ++s) {
        subject.now.push_back({now[s], false, Vec3(0, 0, 0)});
        subject.planned.push_back({piece.fabric().scene().yarns[s].control, false, Vec3(0, 0, 0)});
        subject.per_key.push_back(outline.per_key[piece.strands()[s].yarn]);
        subject.begin.push_back(static_cast<double>(piece.strands()[s].first));
    }
    return subject;
}

/// Crossings of this rank that are lost, and that slid.
std::array<double, 2> order_of(const Outline& outline, const SplitCloth& cloth) {
    std::array<double, 2> found{};
    for (std::size_t b = 0; b < cloth.pieces().size(); ++b) {
        const Piece& piece = *cloth.pieces()[b];
        std::vector<Crossing> crossings;
        for (const Outline::Own& own : outline.crossings) {
            if (own.block != b) continue;
            Crossing crossing = own.crossing;
            const auto place = [&](std::size_t yarn, std::size_t key) {
                return strand_at(piece, static_cast<std::uint32_t>(yarn), outline.per_key[yarn] * static_cast<double>(key));
            };
            const auto weft = place(crossing.weft, crossing.weft_key), warp = place(crossing.warp, crossing.warp_key);
            if (!weft || !warp) {
                ++found[0];
                continue;
            }
            crossing.weft = *weft;
            crossing.warp = *warp;
            crossings.push_back(crossing);
        }
        const sim::CrossingOrder order = sim::crossing_order(crossings, subject_of(piece, outline));
        found[0] += static_cast<double>(order.lost.size());
        found[1] += static_cast<double>(order.slid.size());
    }
    return found;
}

/// A control point on a yarn of a piece, and the segment that begins there; at the end of a yarn, that ends there.
struct OnYarn {
    OnYarn(const Piece& piece, std::uint32_t slot)
        : place(piece.fabric().yarns()[piece.fabric().yarn_of_slot()[slot]]), yarn(piece.fabric().scene().yarns[piece.fabric().yarn_of_slot()[slot]]),
          segment(std::min(slot - place.first_slot - 1 - place.skipped, place.segments - 1)) {}

    const sim::YarnPlace& place;
    const sim::SimYarn& yarn;
    std::uint32_t segment;  ///< of the yarn's
};

/// Strain at a control point, against the rest length of its segment.
double strain_at(const Piece& piece, std::uint32_t slot) {
    const sim::Fabric<double>& fabric = piece.fabric();
    const OnYarn on(piece, slot);
    double rest = static_cast<double>(fabric.constants()[fabric.yarn_of_slot()[slot]].rest_mm);
    if (on.yarn.is_fed) {
        const std::size_t begin = fabric.segment_places()[on.place.first_segment + on.segment].slot;
        rest = sim::Speeds<double>(fabric.gauss(), &piece.state[3 * begin]).length / on.yarn.strain;
    }
    const double speed = (sim::load(&piece.state[3 * std::size_t(slot + 1)]) - sim::load(&piece.state[3 * std::size_t(slot - 1)])).norm() / 2;
    return speed / rest - 1;
}

bool is_held_at(const Piece& piece, std::uint32_t slot) {
    const OnYarn on(piece, slot);
    return sim::is_held_at(on.yarn, on.place.skipped + on.segment);
}

constexpr std::size_t numbers_a_point = 10;

/// Yarn, index, place, planned place, strain and contact force of each of a block's own points.
Comm::Packet packet_of(const Part& part, const Piece& piece, std::span<const double> contact) {
    Comm::Packet packet;
    for (std::size_t i = 0; i < part.own.size(); ++i) {
        const Point& point = part.own[i];
        const std::uint32_t slot = piece.slot_of_own()[i];
        const double* at = &piece.state[3 * std::size_t(slot)];
        packet.insert(packet.end(), {static_cast<double>(point.yarn), static_cast<double>(point.index), at[0], at[1], at[2],
                                     point.planned.x(), point.planned.y(), point.planned.z(), strain_at(piece, slot),
                                     std::hypot(contact[3 * i], contact[3 * i + 1], contact[3 * i + 2])});
    }
    return packet;
}

/// The first rank's end of a file that all fill. One repeat of a cloth is written as often as it fills the cloth, as sim::copied_back() has it.
class Filing {
  public:
    Filing(FileInPieces& file, const YarnsLayout& layout, const Cut& cut, const Outline& outline)
        : m_file(file), m_layout(layout), m_outline(outline), m_cut(cut), m_times(outline.plan.repeats), m_first{0} {
        m_wefts = wefts_of(outline);
        for (const std::size_t points : points_of_file(cut, outline)) m_first.push_back(m_first.back() + points);
    }

    /// Control points of each yarn of the file.
    static std::vector<std::size_t> points_of_file(const Cut& cut, const Outline& outline) {
        const std::size_t wefts = wefts_of(outline);
        const auto& [x, y] = outline.plan.repeats;
        std::vector<std::size_t> points;
        for (std::size_t copy = 0; copy < x; ++copy) {
            for (std::size_t weft = 0; weft < wefts; ++weft) points.push_back(cut.points[weft] * y);
        }
        for (std::size_t copy = 0; copy < y; ++copy) {
            for (std::size_t warp = wefts; warp < cut.points.size(); ++warp) points.push_back(cut.points[warp] * x);
        }
        return points;
    }

    /// Points that follow one another along a yarn are written at once.
    Status file_points(const Comm::Packet& packet) {
        Run run;
        for (std::size_t at = 0; at < packet.size(); at += numbers_a_point) {
            const double* from = &packet[at];
            const auto yarn = static_cast<std::size_t>(from[0]), index = static_cast<std::size_t>(from[1]);
            if (!run.control.empty() && (yarn != run.yarn || index != run.index + run.control.size())) {
                WEAVE_CHECK_OK(file_copies(run));
                run = {};
            }
            if (run.control.empty()) run.yarn = yarn, run.index = index;
            run.control.emplace_back(from[2], from[3], from[4]);
            run.planned.emplace_back(from[5], from[6], from[7]);
            run.strain.push_back(from[8]);
            run.contact.push_back(from[9]);
        }
        return run.control.empty() ? Status() : file_copies(run);
    }

    Status file_crossings(const Comm::Packet& packet) {
        for (std::size_t x = 0; x < m_times[0]; ++x) {
            for (std::size_t y = 0; y < m_times[1]; ++y) WEAVE_CHECK_OK(file_crossings(packet, x, y));
        }
        return {};
    }

  private:
    struct Run {
        std::size_t yarn = 0, index = 0;
        std::vector<Vec3> control, planned;
        std::vector<double> strain, contact;
    };

    static std::size_t wefts_of(const Outline& outline) {
        return static_cast<std::size_t>(std::ranges::count(outline.bare.yarns, System::weft, &SimulatedYarn::system));
    }

    Status file_copies(const Run& run) {
        for (std::size_t x = 0; x < m_times[0]; ++x) {
            for (std::size_t y = 0; y < m_times[1]; ++y) WEAVE_CHECK_OK(file_copy(run, x, y));
        }
        return {};
    }

    Status file_copy(const Run& run, std::size_t x, std::size_t y) {
        const bool is_weft = run.yarn < m_wefts;
        const std::size_t yarn = is_weft ? x * m_wefts + run.yarn : m_times[0] * m_wefts + y * (m_cut.points.size() - m_wefts) + run.yarn - m_wefts;
        const std::uint64_t begin = m_first[yarn] + (is_weft ? y : x) * m_cut.points[run.yarn] + run.index;
        const Vec3 aside(static_cast<double>(x) * m_outline.bare.size_mm[0], static_cast<double>(y) * m_outline.bare.size_mm[1], 0);
        WEAVE_CHECK_OK(m_file.write(m_layout.control + 24 * begin, file_bytes(numbers_of(run.control, aside))));
        WEAVE_CHECK_OK(m_file.write(m_layout.planned + 24 * begin, file_bytes(numbers_of(run.planned, aside))));
        WEAVE_CHECK_OK(m_file.write(m_layout.strain + 8 * begin, file_bytes(run.strain)));
        return m_file.write(m_layout.contact_N + 8 * begin, file_bytes(run.contact));
    }

    static std::vector<double> numbers_of(const std::vector<Vec3>& places, const Vec3& aside) {
        std::vector<double> numbers;
        for (const Vec3& place : places) {
            const Vec3 moved = place + aside;
            numbers.insert(numbers.end(), moved.data(), moved.data() + 3);
        }
        return numbers;
    }

    Status file_crossings(const Comm::Packet& packet, std::size_t x, std::size_t y) {
        const sim::Plan& plan = m_outline.plan;
        const std::uint64_t before = (x * m_times[1] + y) * m_outline.all_crossings;
        std::vector<Crossing> run;
        std::uint64_t begin = 0;
        for (std::size_t at = 0; at < packet.size(); at += 8) {
            const auto whole = [&](std::size_t k) { return static_cast<std::size_t>(packet[at + k]); };
            if (run.empty()) begin = whole(0);
            run.push_back({x * m_wefts + whole(1), whole(2) + y * m_outline.keys[whole(1)],
                           m_times[0] * m_wefts + y * (m_cut.points.size() - m_wefts) + whole(3) - m_wefts, whole(4) + x * m_outline.keys[whole(3)],
                           whole(5) + x * (plan.cloth_picks / m_times[0]), whole(6) + y * (plan.cloth_ends / m_times[1]), whole(7) != 0});
            if (at + 8 < packet.size() && static_cast<std::uint64_t>(packet[at + 8]) == begin + run.size()) continue;
            WEAVE_CHECK_OK(m_file.write(m_layout.crossings + 28 * (before + begin), file_bytes(run)));
            run.clear();
        }
        return {};
    }

    FileInPieces& m_file;
    const YarnsLayout& m_layout;
    const Outline& m_outline;
    const Cut& m_cut;
    std::array<std::size_t, 2> m_times;
    std::size_t m_wefts = 0;
    std::vector<std::size_t> m_first;  ///< point of each yarn of the file
};

Comm::Packet crossings_packet(const Outline& outline, std::size_t block) {
    Comm::Packet packet;
    for (const Outline::Own& own : outline.crossings) {
        if (own.block != block) continue;
        const Crossing& c = own.crossing;
        for (const std::size_t part : {std::size_t(own.number), c.weft, c.weft_key, c.warp, c.warp_key, c.pick, c.end, std::size_t(c.weft_over)})
            packet.push_back(static_cast<double>(part));
    }
    return packet;
}

/// What is known of the yarns of the file once they lie at rest.
Yarns labelled(const Design& design, const Cut& cut, const Outline& outline, const Measured& measured, Json report) {
    Yarns yarns = outline.bare;
    for (std::size_t y = 0; y < yarns.yarns.size(); ++y) {
        SimulatedYarn& yarn = yarns.yarns[y];
        yarn.length_mm = measured.length_mm[y];
        yarn.rest_length_mm = cut.yarns[y].is_fed ? yarn.length_mm / cut.yarns[y].strain : cut.yarns[y].rest_mm;
    }
    yarns.report = std::move(report);
    return sim::copied_back(std::move(yarns), outline.plan, design);
}

/// To the first rank, from whichever has them; the others get nothing.
Comm::Packet to_first(Comm& comm, std::size_t from, Comm::Packet own, std::size_t size) {
    if (from == 0) return comm.is_first() ? std::move(own) : Comm::Packet();
    std::vector<Comm::Letter> out, in;
    if (size == 0) return {};
    if (comm.rank() == from) out.push_back({0, std::move(own)});
    if (comm.is_first()) in.push_back({from, Comm::Packet(size)});
    comm.exchange(out, in);
    return in.empty() ? Comm::Packet() : std::move(in.front().numbers);
}

}  // namespace

Outline outline_of(const Design& design, const sim::PlanInStretches& stretches, const std::vector<Part>& parts) {
    const sim::Plan& plan = stretches.plan();
    Outline outline;
    Yarns& yarns = outline.bare;
    yarns.title = design.title;
    yarns.design_sha256 = design_sha256(design);
    yarns.scene_sha256 = scene_sha256(design);
    yarns.size_mm = plan.curves.size_mm;
    yarns.is_periodic = plan.curves.is_periodic;
    yarns.region = plan.curves.region;
    yarns.cloth_rows = plan.cloth_rows;
    yarns.cloth_columns = plan.cloth_columns;
    for (std::size_t y = 0; y < plan.curve_of.size(); ++y) {
        const sim::SimYarn& from = plan.scene.yarns[y];
        SimulatedYarn yarn = sim::labelled_yarn(design, plan.curves.yarns[plan.curve_of[y]]);
        yarn.radius_mm = from.radius_mm;
        yarn.spline.is_periodic = from.is_periodic;
        yarn.spline.shift = from.shift;
        yarn.planned_length_mm = from.is_periodic ? from.shift.norm() : (stretches.point(y, stretches.points(y) - 1) - stretches.point(y, 0)).norm();
        yarns.yarns.push_back(std::move(yarn));
        outline.per_key.push_back(points_per_key_of(stretches, y));
    }
    sim::CrossedYarns crossed;
    stretches.each_crossing([&](const Crossing& crossing) {
        crossed.add(crossing);
        ++outline.planned_crossings;
        if (crossing.weft == sim::PlanInStretches::none || crossing.warp == sim::PlanInStretches::none) return;
        const auto index = static_cast<std::size_t>(std::lround(outline.per_key[crossing.weft] * static_cast<double>(crossing.weft_key))) % stretches.points(crossing.weft);
        const auto block = part_with(parts, static_cast<std::uint32_t>(crossing.weft), static_cast<std::uint32_t>(index));
        if (block) outline.crossings.push_back({crossing, outline.all_crossings, *block});
        ++outline.all_crossings;
    });
    outline.plan = plan;
    for (std::size_t y = 0; y < plan.curve_of.size(); ++y) outline.keys.push_back(stretches.keys(y));
    outline.coverage = sim::coverage_of(plan, crossed);
    outline.lines = sim::lines_json(plan);
    outline.fidelity = plan.fidelity;
    outline.points_per_key = plan.points_per_key;
    outline.goal = plan.goal;
    return outline;
}

Measured measure(Comm& comm, const Cut& cut, const std::vector<Part>& parts, const Outline& outline, SplitCloth& cloth) {
    Measured measured;
    measured.length_mm = cloth.lengths();
    const std::array<double, 2> order = order_of(outline, cloth);
    std::array<double, 4> greatest{};  // overlap, strain of warps and of wefts
    double seen = 0;
    for (std::size_t b = 0; b < parts.size(); ++b) {
        Piece& piece = *cloth.pieces()[b];
        const sim::Contacts contacts = sim::contacts_of(piece.energy(), piece.state);
        seen += static_cast<double>(contacts.seen);
        greatest[0] = std::max(greatest[0], contacts.overlap);
        for (std::size_t i = 0; i < parts[b].own.size(); ++i) {
            const std::uint32_t y = parts[b].own[i].yarn;
            const std::uint32_t slot = piece.slot_of_own()[i];
            if (is_held_at(piece, slot)) continue;
            double& most = greatest[outline.bare.yarns[y].system == System::warp ? 1 : 2];
            most = std::max(most, std::abs(strain_at(piece, slot) - (cut.yarns[y].is_fed ? cut.yarns[y].strain - 1 : 0)));
        }
    }
    double lost = 0, slid = 0, all_seen = 0;
    for (const Comm::Packet& of_rank : comm.gather(Comm::Packet{order[0], order[1], seen, greatest[0], greatest[1], greatest[2]})) {
        lost += of_rank[0];
        slid += of_rank[1];
        all_seen += of_rank[2];
        measured.max_overlap = std::max(measured.max_overlap, of_rank[3]);
        for (std::size_t k = 0; k < 2; ++k) measured.strain_deviation[k] = std::max(measured.strain_deviation[k], of_rank[4 + k]);
    }
    measured.lost = static_cast<std::size_t>(lost);
    measured.slid = static_cast<std::size_t>(slid);
    measured.contacts = static_cast<std::size_t>(all_seen) / 2;
    return measured;
}

Status write_split(Comm& comm, const Design& design, const Cut& cut, const std::vector<Part>& parts, const Outline& outline, const Measured& measured,
                   SplitCloth& cloth, Json report, const std::filesystem::path& out) {
    std::vector<double> contact;
    cloth.contact_forces(contact);
    Comm::Packet sizes;  // of both packets of each block
    for (std::size_t b = 0; b < parts.size(); ++b) {
        sizes.push_back(static_cast<double>(numbers_a_point * parts[b].own.size()));
        sizes.push_back(static_cast<double>(crossings_packet(outline, b).size()));
    }
    const std::vector<Comm::Packet> all_sizes = comm.gather(sizes);
    std::optional<FileInPieces> file;
    YarnsLayout layout;
    const auto begin = [&]() -> Status {
        const std::size_t copies = outline.plan.repeats[0] * outline.plan.repeats[1];
        WEAVE_TRY(layout, lay_out_yarns(labelled(design, cut, outline, measured, std::move(report)), Filing::points_of_file(cut, outline), copies * outline.all_crossings));
        WEAVE_TRY(FileInPieces begun, FileInPieces::begin(out));
        file.emplace(std::move(begun));
        return file->write(0, layout.front);
    };
    Status status = comm.is_first() ? begin() : Status();
    for (std::size_t rank = 0; rank < comm.size(); ++rank) {
        for (std::size_t b = 0; 2 * b < all_sizes[rank].size(); ++b) {
            const auto size = [&](std::size_t k) { return static_cast<std::size_t>(all_sizes[rank][2 * b + k]); };
            const bool is_mine = rank == comm.rank();
            Comm::Packet points, crossings;
            if (is_mine) {
                const auto& first = cloth.first_slots();
                points = packet_of(parts[b], *cloth.pieces()[b], std::span(contact).subspan(first[b], first[b + 1] - first[b]));
                crossings = crossings_packet(outline, b);
            }
            points = to_first(comm, rank, std::move(points), size(0));
            crossings = to_first(comm, rank, std::move(crossings), size(1));
            if (!comm.is_first() || !status) continue;
            Filing filing(*file, layout, cut, outline);
            status = filing.file_points(points);
            if (status) status = filing.file_crossings(crossings);
        }
    }
    if (comm.is_first() && status) status = file->finish();
    return agreed(comm, status);
}

}  // namespace weave::ranks
