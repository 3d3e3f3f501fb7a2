#include <weave/ranks/lay.hpp>

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <optional>
#include <span>
#include <tuple>

namespace weave::ranks {

namespace {

using Box = Eigen::AlignedBox3d;

/// A lay lasts until a point has gone half of this, in smallest sums of two radii.
constexpr double margin = 1.0;

double margin_mm(const Cut& cut) {
    return margin * 2 * cut.terms.least_radius_mm;
}

auto key_of(const Met& met) {
    return std::tuple(met.point.yarn, met.image, met.turns, met.point.index);
}

/// A block's points, its own and those along its yarns, and where they lie.
struct Known {
    struct Entry {
        Met met;
        std::int64_t along = 0;
        Vec3 place{0, 0, 0};
    };
    std::vector<Entry> entries;  ///< by yarn and along it
    Box box;

    Known(const Cut& cut, const Part& part, const double* own, const double* guests) {
        for (std::size_t i = 0; i < part.own.size(); ++i) add(cut, {part.own[i], 0, {}}, Eigen::Map<const Vec3>(own + 3 * i));
        for (std::size_t g = 0; g < part.along.size(); ++g)
            add(cut, part.along[g], Eigen::Map<const Vec3>(guests + 3 * g) + moved_by(cut, part.along[g]));
        std::sort(entries.begin(), entries.end(), [](const Entry& a, const Entry& b) { return key(a) < key(b); });
    }

    /// visit(points) with the points that each segment of the block's own follows from.
    template <class Visit>
    void each_segment(const Cut& cut, const Part& part, const Visit& visit) const {
        for (const Point& start : part.own) {
            const sim::SimYarn& yarn = cut.yarns[start.yarn];
            if (!yarn.is_periodic && start.index + 1 >= cut.points[start.yarn]) continue;
            const auto wanted = std::pair(start.yarn, std::int64_t{start.index} - 1);
            const auto first = std::lower_bound(entries.begin(), entries.end(), wanted, [](const Entry& a, const auto& k) { return key(a) < k; });
            auto last = first;
            while (last != entries.end() && last->met.point.yarn == start.yarn && last->along <= std::int64_t{start.index} + 2) ++last;
            visit(std::span(first, last));
        }
    }

  private:
    static std::pair<std::uint32_t, std::int64_t> key(const Entry& entry) { return {entry.met.point.yarn, entry.along}; }
    void add(const Cut& cut, const Met& met, const Vec3& place) {
        entries.push_back({met, std::int64_t{met.point.index} + std::int64_t{met.turns} * cut.points[met.point.yarn], place});
        box.extend(place);
    }
};

/// The same point seen so many periods away. Whole turns of a closed yarn lie on the very same strand.
Met seen_from(const Cut& cut, Met met, const std::array<std::int16_t, 2>& image) {
    const sim::SimYarn& yarn = cut.yarns[met.point.yarn];
    met.image = image;
    for (std::size_t k = 0; k < 2; ++k) {
        if (!yarn.is_periodic || yarn.turns[k] == 0 || met.image[k] == 0) continue;
        const int turns = met.image[k] / yarn.turns[k];
        met.turns += turns;
        for (std::size_t j = 0; j < 2; ++j) met.image[j] = static_cast<std::int16_t>(met.image[j] - turns * yarn.turns[j]);
    }
    return met;
}

/// The images of a box that may come near another, first and last by axis.
std::array<std::array<int, 2>, 2> images_near(const Cut& cut, const Box& box, const Box& other) {
    std::array<std::array<int, 2>, 2> images{};
    for (std::size_t k = 0; k < 2; ++k) {
        const auto axis = static_cast<Eigen::Index>(k);
        const double period = cut.terms.period_mm[k];
        if (!cut.terms.is_periodic[k] || !(period > 0)) continue;
        images[k] = {static_cast<int>(std::ceil((other.min()[axis] - box.max()[axis]) / period)),
                     static_cast<int>(std::floor((other.max()[axis] - box.min()[axis]) / period))};
    }
    return images;
}

constexpr std::size_t numbers_a_point = 11;

void write(Comm::Packet& packet, std::size_t to_block, const Met& met) {
    const Point& p = met.point;
    packet.insert(packet.end(), {static_cast<double>(to_block), static_cast<double>(p.yarn), static_cast<double>(p.index),
                                 static_cast<double>(p.block), p.is_frozen ? 1.0 : 0.0, p.planned.x(), p.planned.y(), p.planned.z(),
                                 static_cast<double>(met.turns), static_cast<double>(met.image[0]), static_cast<double>(met.image[1])});
}

Met read(const double* at) {
    const auto whole = [&](std::size_t k) { return static_cast<std::uint32_t>(at[k]); };
    return {{whole(1), whole(2), whole(3), at[4] != 0, {at[5], at[6], at[7]}},
            static_cast<std::int32_t>(at[8]),
            {static_cast<std::int16_t>(at[9]), static_cast<std::int16_t>(at[10])}};
}

/// The boxes of all blocks, widened by as far as yarns of others may come.
std::vector<Box> boxes_of_all(Comm& comm, const Cut& cut, const std::vector<Known>& known) {
    std::vector<double> own, all;
    for (const Known& block : known) {
        for (Eigen::Index k = 0; k < 3; ++k) own.push_back(block.box.min()[k]);
        for (Eigen::Index k = 0; k < 3; ++k) own.push_back(block.box.max()[k]);
    }
    std::vector<std::size_t> counts;
    for (std::size_t rank = 0; rank < comm.size(); ++rank) {
        const auto [first, last] = cut.blocks_of(rank, comm.size());
        counts.push_back(6 * (last - first));
    }
    comm.gather(own, counts, all);
    double thickest = 0;
    for (const sim::SimYarn& yarn : cut.yarns) thickest = std::max(thickest, yarn.radius_mm);
    const Vec3 wider = Vec3::Constant(2 * thickest + margin_mm(cut));
    std::vector<Box> boxes;
    for (std::size_t at = 0; at < all.size(); at += 6)
        boxes.emplace_back(Vec3(Eigen::Map<const Vec3>(&all[at]) - wider), Vec3(Eigen::Map<const Vec3>(&all[at + 3]) + wider));
    return boxes;
}

/// What a block offers another of its segments, `images` away.
void offer(const Cut& cut, const Part& part, const Known& known, const Box& near, const std::array<std::int16_t, 2>& image, std::vector<Met>& offered) {
    const Vec3 moved(image[0] * cut.terms.period_mm[0], image[1] * cut.terms.period_mm[1], 0);
    known.each_segment(cut, part, [&](std::span<const Known::Entry> points) {
        Box box;
        for (const Known::Entry& entry : points) box.extend(entry.place + moved);
        if (!near.intersects(box)) return;
        for (const Known::Entry& entry : points) offered.push_back(seen_from(cut, entry.met, image));
    });
}

void sort_out(std::vector<Met>& met) {
    std::sort(met.begin(), met.end(), [](const Met& a, const Met& b) { return key_of(a) < key_of(b); });
    met.erase(std::unique(met.begin(), met.end(), [](const Met& a, const Met& b) { return key_of(a) == key_of(b); }), met.end());
}

/// The guests of each block of this rank: what the blocks of all ranks offer, and the points along its own.
std::vector<std::vector<Met>> find_guests(Comm& comm, const Cut& cut, const std::vector<Part>& parts, const std::vector<Known>& known) {
    const std::vector<Box> boxes = boxes_of_all(comm, cut, known);
    const std::size_t first = cut.blocks_of(comm.rank(), comm.size())[0];
    std::vector<Comm::Packet> offers(comm.size());
    for (std::size_t b = 0; b < parts.size(); ++b) {
        for (std::size_t other = 0; other < boxes.size(); ++other) {
            std::vector<Met> offered;
            const auto images = images_near(cut, known[b].box, boxes[other]);
            for (int i = images[0][0]; i <= images[0][1]; ++i) {
                for (int j = images[1][0]; j <= images[1][1]; ++j) {
                    if (other == first + b && i == 0 && j == 0) continue;
                    const std::array<std::int16_t, 2> image{static_cast<std::int16_t>(i), static_cast<std::int16_t>(j)};
                    Box moved = known[b].box;
                    moved.translate(Vec3(i * cut.terms.period_mm[0], j * cut.terms.period_mm[1], 0));
                    if (boxes[other].intersects(moved)) offer(cut, parts[b], known[b], boxes[other], image, offered);
                }
            }
            sort_out(offered);
            for (const Met& met : offered) write(offers[cut.rank_of(other, comm.size())], other, met);
        }
    }
    std::vector<std::vector<Met>> guests = points_along(parts);
    for (const Comm::Packet& packet : comm.swap(std::move(offers))) {
        for (std::size_t at = 0; at < packet.size(); at += numbers_a_point)
            guests[static_cast<std::size_t>(packet[at]) - first].push_back(read(&packet[at]));
    }
    for (std::size_t b = 0; b < guests.size(); ++b) {
        std::erase_if(guests[b], [&](const Met& met) { return met.point.block == first + b && met.turns == 0 && met.image == std::array<std::int16_t, 2>{}; });
        sort_out(guests[b]);
    }
    return guests;
}

}  // namespace

double travel_mm(const Cut& cut) {
    return margin_mm(cut) / 2;
}

std::vector<std::vector<Met>> points_along(const std::vector<Part>& parts) {
    std::vector<std::vector<Met>> along;
    for (const Part& part : parts) along.push_back(part.along);
    return along;
}

std::unique_ptr<Lay> lay_out(Comm& comm, const Cut& cut, const std::vector<Part>& parts, Exchange& along, const std::vector<double>& own,
                             const sim::Executor& executor) {
    std::vector<double> beside;
    along.run(own, beside);
    std::vector<Known> known;
    std::size_t own_at = 0, along_at = 0;
    for (const Part& part : parts) {
        known.emplace_back(cut, part, own.data() + own_at, beside.data() + along_at);
        own_at += 3 * part.own.size();
        along_at += 3 * part.along.size();
    }
    std::vector<std::vector<Met>> guests = find_guests(comm, cut, parts, known);
    auto lay = std::make_unique<Lay>();
    lay->exchange = Exchange(comm, cut, parts, guests);
    for (std::size_t b = 0; b < parts.size(); ++b)
        lay->pieces.push_back(std::make_unique<Piece>(cut, parts[b], std::move(guests[b]), executor));
    return lay;
}

}  // namespace weave::ranks
