#include <weave/ranks/piece.hpp>

#include <algorithm>
#include <array>
#include <tuple>
#include <utility>

namespace weave::ranks {

Vec3 moved_by(const Cut& cut, const Met& met) {
    Vec3 moved = met.turns * cut.yarns[met.point.yarn].shift;
    for (std::size_t k = 0; k < 2; ++k) moved[static_cast<Eigen::Index>(k)] += met.image[k] * cut.terms.period_mm[k];
    return moved;
}

/// The yarns of a piece, each a run of points that follow one another.
struct Piece::Yarns {
    sim::SimScene scene;
    /// Strand and place along it of each own point, and of each guest.
    std::vector<std::array<std::uint32_t, 2>> own, guests;
    std::vector<Strand> strands;

    Yarns(const Cut& cut, const Part& part, const std::vector<Met>& met) : scene(cut.terms), own(part.own.size()), guests(met.size()) {
        scene.is_periodic = {false, false};  // whatever repeats is here as a guest
        std::vector<Entry> entries;
        for (std::uint32_t i = 0; i < part.own.size(); ++i)
            entries.push_back({part.own[i].yarn, {}, part.own[i].index, i, false, part.own[i].is_frozen, part.own[i].planned});
        for (std::uint32_t g = 0; g < met.size(); ++g) {
            const Point& point = met[g].point;
            entries.push_back({point.yarn, met[g].image, std::int64_t{point.index} + std::int64_t{met[g].turns} * cut.points[point.yarn], g,
                               true, point.is_frozen, point.planned + moved_by(cut, met[g])});
        }
        std::sort(entries.begin(), entries.end(), [](const Entry& a, const Entry& b) { return a.key() < b.key(); });
        for (std::size_t first = 0, last = 0; first < entries.size(); first = last) {
            last = first + 1;
            while (last < entries.size() && entries[last].follows(entries[last - 1])) ++last;
            add(cut, std::span(entries).subspan(first, last - first));
        }
    }

  private:
    struct Entry {
        std::uint32_t yarn;
        std::array<std::int16_t, 2> image;
        std::int64_t along;
        std::uint32_t number;
        bool is_guest, is_frozen;
        Vec3 planned;

        [[nodiscard]] std::tuple<std::uint32_t, std::array<std::int16_t, 2>, std::int64_t> key() const { return {yarn, image, along}; }
        [[nodiscard]] bool follows(const Entry& before) const {
            return yarn == before.yarn && image == before.image && along == before.along + 1;
        }
    };

    void add(const Cut& cut, std::span<const Entry> run) {
        const std::uint32_t of = run.front().yarn;
        sim::SimYarn yarn = cut.yarns[of];
        const bool is_closed = yarn.is_periodic;
        yarn.is_periodic = false;
        yarn.is_cut = {is_closed || run.front().along > 0, is_closed || run.back().along + 1 < cut.points[of]};
        for (std::uint32_t at = 0; at < run.size(); ++at) {
            yarn.control.push_back(run[at].planned);
            yarn.frozen.push_back(run[at].is_frozen ? 1 : 0);
            yarn.guests.push_back(run[at].is_guest ? 1 : 0);
            (run[at].is_guest ? guests : own)[run[at].number] = {static_cast<std::uint32_t>(scene.yarns.size()), at};
        }
        scene.yarns.push_back(std::move(yarn));
        strands.push_back({of, run.front().image, run.front().along});
    }
};

Piece::Piece(const Cut& cut, const Part& part, std::vector<Met> guests, const sim::Executor& executor)
    : Piece(cut, guests, executor, Yarns(cut, part, guests)) {}

Piece::Piece(const Cut& cut, std::vector<Met> guests, const sim::Executor& executor, const Yarns& yarns)
    : m_guests(std::move(guests)), m_strands(yarns.strands), m_fabric(yarns.scene), m_energy(m_fabric, executor), m_hessian(m_fabric) {
    for (const Met& guest : m_guests) m_moved.push_back(moved_by(cut, guest));
    std::vector<std::uint32_t> row_of_slot(m_fabric.slots(), none);
    const std::vector<std::uint32_t>& slot_of_row = m_hessian.slot_of_row();
    for (std::uint32_t row = 0; row < slot_of_row.size(); ++row) row_of_slot[slot_of_row[row]] = row;
    const auto find = [&](const auto& places, std::vector<std::uint32_t>& slots, std::vector<std::uint32_t>& rows) {
        for (const auto& [strand, at] : places) {
            slots.push_back(m_fabric.yarns()[strand].first_slot + 1 + at);
            rows.push_back(row_of_slot[slots.back()]);
        }
    };
    find(yarns.own, m_slot_of_own, m_row_of_own);
    find(yarns.guests, m_slot_of_guest, m_row_of_guest);
    // Which samples lie on one stretch of a yarn is decided where they are planned: the same whenever a piece is made anew.
    m_energy.first_weights(m_fabric.state());
}

void Piece::lay_state(std::span<const double> own, std::span<const double> guests, std::vector<double>& slots) const {
    slots.assign(3 * m_fabric.slots(), 0);
    for (std::size_t i = 0; i < m_slot_of_own.size(); ++i) {
        for (std::size_t k = 0; k < 3; ++k) slots[3 * m_slot_of_own[i] + k] = own[3 * i + k];
    }
    for (std::size_t g = 0; g < m_slot_of_guest.size(); ++g) {
        for (std::size_t k = 0; k < 3; ++k)
            slots[3 * m_slot_of_guest[g] + k] = guests[3 * g + k] + m_moved[g][static_cast<Eigen::Index>(k)];
    }
    m_fabric.follow(slots);
}

void Piece::lay_change(std::span<const double> own, std::span<const double> guests, std::vector<double>& slots) const {
    slots.assign(3 * m_fabric.slots(), 0);
    for (std::size_t i = 0; i < m_slot_of_own.size(); ++i) {
        for (std::size_t k = 0; k < 3; ++k) slots[3 * m_slot_of_own[i] + k] = own[3 * i + k];
    }
    for (std::size_t g = 0; g < m_slot_of_guest.size(); ++g) {
        for (std::size_t k = 0; k < 3; ++k) slots[3 * m_slot_of_guest[g] + k] = guests[3 * g + k];
    }
    m_fabric.follow_change(slots);
}

void Piece::take(const std::vector<double>& slots, std::span<double> own) const {
    for (std::size_t i = 0; i < m_slot_of_own.size(); ++i) {
        for (std::size_t k = 0; k < 3; ++k) own[3 * i + k] = slots[3 * m_slot_of_own[i] + k];
    }
}

}  // namespace weave::ranks
