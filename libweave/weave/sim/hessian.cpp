#include <weave/sim/hessian.hpp>

#include <weave/sim/hessian_terms.hpp>

#include <algorithm>
#include <array>

namespace weave::sim {

namespace {

constexpr std::uint32_t chunk_segments = 32;

template <class Real>
Basis<double> as_double(const Basis<Real>& basis) {
    Basis<double> same;
    for (int c = 0; c < 4; ++c) {
        same.value[c] = static_cast<double>(basis.value[c]);
        same.slope[c] = static_cast<double>(basis.slope[c]);
        same.bend[c] = static_cast<double>(basis.bend[c]);
    }
    return same;
}

template <class Real>
YarnConstants<double> as_double(const YarnConstants<Real>& y) {
    return {static_cast<double>(y.radius_mm), static_cast<double>(y.stretch_N), static_cast<double>(y.bending),
            static_cast<double>(y.tension_N), static_cast<double>(y.evenness_N), static_cast<double>(y.rest_mm),
            static_cast<double>(y.root_k),    y.supply,
            y.samples,                        y.basis};
}

template <class Real>
Gauss<double> as_double(const Gauss<Real>& gauss) {
    Gauss<double> same;
    for (std::size_t g = 0; g < gauss_points; ++g) {
        same.basis[g] = as_double(gauss.basis[g]);
        same.weight[g] = static_cast<double>(gauss.weight[g]);
    }
    return same;
}

}  // namespace

/// What one thread needs while it works on a segment.
template <class Real>
struct Hessian<Real>::Scratch {
    SlotBlocks own;
    std::vector<SlotBlocks> other;  ///< per near segment
    std::vector<std::uint8_t> touched;
    double slots[12];
};

template <class Real>
Hessian<Real>::Hessian(const Fabric<Real>& fabric) : m_fabric(fabric), m_gauss(as_double(fabric.gauss())), m_spheres(spheres_of<double>(fabric.scene())) {
    for (const Basis<Real>& basis : fabric.bases()) m_bases.push_back(as_double(basis));
    for (const YarnConstants<Real>& yarn : fabric.constants()) m_constants.push_back(as_double(yarn));
    make_shares();
    make_chunks();
}

template <class Real>
void Hessian<Real>::make_shares() {
    const std::vector<std::uint8_t>& moves = m_fabric.moves();
    std::vector<std::uint32_t> row_of_slot(moves.size(), 0);
    for (std::uint32_t slot = 0; slot < moves.size(); ++slot) {
        if (moves[slot] == 0) continue;
        row_of_slot[slot] = static_cast<std::uint32_t>(m_slot_of_row.size());
        m_slot_of_row.push_back(slot);
    }
    std::vector<std::vector<Share>> shares(moves.size());
    for (std::uint32_t slot = 0; slot < moves.size(); ++slot) {
        if (moves[slot] != 0) shares[slot].push_back({row_of_slot[slot], 1});
    }
    for (const FollowSlot& follow : m_fabric.follows()) {
        for (std::size_t k = 0; k < 2; ++k) {
            if (follow.weight[k] != 0 && moves[follow.from[k]] != 0)
                shares[follow.slot].push_back({row_of_slot[follow.from[k]], static_cast<float>(follow.weight[k])});
        }
    }
    std::vector<std::vector<std::uint32_t>> segments(m_slot_of_row.size());
    for (std::uint32_t s = 0; s < m_fabric.segments(); ++s) {
        for (std::uint32_t c = 0; c < 4; ++c) {
            for (const Share& share : shares[m_fabric.segment_places()[s].slot + c]) segments[share.row].push_back(s);
        }
    }
    for (const std::vector<std::uint32_t>& of_row : segments) {
        m_segments_of_row.insert(m_segments_of_row.end(), of_row.begin(), of_row.end());
        m_first_segment.push_back(static_cast<std::uint32_t>(m_segments_of_row.size()));
    }
    m_first_share.assign(1, 0);
    for (const std::vector<Share>& of_slot : shares) {
        m_shares.insert(m_shares.end(), of_slot.begin(), of_slot.end());
        m_first_share.push_back(static_cast<std::uint32_t>(m_shares.size()));
    }
}

/// Each chunk of segments adds to rows of its own yarn alone, a few of which its neighbours along the yarn share. So
/// even and odd chunks take turns, and the last waits where it meets the first.
template <class Real>
void Hessian<Real>::make_chunks() {
    m_chunks.resize(3);
    for (const YarnPlace& yarn : m_fabric.yarns()) {
        const std::uint32_t count = std::max<std::uint32_t>(1, yarn.segments / chunk_segments);
        for (std::uint32_t c = 0; c < count; ++c) {
            const std::size_t colour = c + 1 == count && c > 0 && c % 2 == 0 ? 2 : c % 2;
            m_chunks[colour].push_back({yarn.first_segment + yarn.segments * c / count,
                                        yarn.first_segment + yarn.segments * (c + 1) / count});
        }
    }
}

template <class Real>
void Hessian<Real>::list_near_segments(Energy<Real>& energy) {
    Neighbours<Real>& neighbours = energy.neighbours();
    const FrictionView<Real> rubbing = energy.friction().view();
    m_first_near.assign(m_fabric.segments() + 1, 0);
    m_near.clear();
    std::vector<std::uint32_t> seen(m_fabric.segments(), 0xffffffffU);
    for (std::uint32_t s = 0; s < m_fabric.segments(); ++s) {
        const SegmentPlace& segment = m_fabric.segment_places()[s];
        const std::size_t begin = m_near.size();
        const auto add = [&](std::uint32_t own_sample) {
            const std::uint32_t other = neighbours.segment_of(own_sample);
            if (seen[other] == s) return;
            seen[other] = s;
            m_near.push_back(other);
        };
        for (std::uint32_t k = 0; k < m_fabric.constants()[segment.yarn].samples; ++k) {
            const std::uint32_t sample = segment.sample + k;
            for (std::uint32_t e = neighbours.first()[sample]; e < neighbours.first()[sample + 1]; ++e)
                add(neighbours.own(neighbours.others()[e]));
            if (!energy.friction().is_on()) continue;
            for (std::uint32_t p = rubbing.first[sample]; p < rubbing.first[sample + 1]; ++p) add(rubbing.pairs[p].other);
        }
        std::sort(m_near.begin() + static_cast<std::ptrdiff_t>(begin), m_near.end());
        m_first_near[s + 1] = static_cast<std::uint32_t>(m_near.size());
    }
}

/// The rows that a control point meets, some of them more than once: those of its own segments, and of the segments
/// near to these.
template <class Real>
void Hessian<Real>::list_columns(std::uint32_t row, std::vector<std::uint32_t>& columns) const {
    const auto add_slots = [&](std::uint32_t segment) {
        const std::uint32_t slot = m_fabric.segment_places()[segment].slot;
        for (std::uint32_t j = m_first_share[slot]; j < m_first_share[slot + 4]; ++j) columns.push_back(m_shares[j].row);
    };
    std::vector<std::uint32_t> near;
    for (std::uint32_t i = m_first_segment[row]; i < m_first_segment[row + 1]; ++i) {
        const std::uint32_t segment = m_segments_of_row[i];
        near.push_back(segment);
        near.insert(near.end(), m_near.begin() + m_first_near[segment], m_near.begin() + m_first_near[segment + 1]);
    }
    std::sort(near.begin(), near.end());
    near.erase(std::unique(near.begin(), near.end()), near.end());
    for (const std::uint32_t segment : near) add_slots(segment);
}

template <class Real>
void Hessian<Real>::make_shape(Energy<Real>& energy, BlockMatrix& matrix) {
    list_near_segments(energy);
    constexpr std::size_t rows_at_once = 256;
    std::vector<std::vector<std::uint32_t>> parts((rows() + rows_at_once - 1) / rows_at_once);
    std::vector<std::uint32_t> first(rows() + 1, 0);
    energy.executor().each(parts.size(), [&](std::size_t part) {
        std::vector<std::uint32_t>& columns = parts[part];
        for (std::size_t row = part * rows_at_once; row < std::min(rows(), (part + 1) * rows_at_once); ++row) {
            const std::size_t before = columns.size();
            list_columns(static_cast<std::uint32_t>(row), columns);
            const auto begin = columns.begin() + static_cast<std::ptrdiff_t>(before);
            std::sort(begin, columns.end());
            columns.erase(std::unique(begin, columns.end()), columns.end());
            first[row + 1] = static_cast<std::uint32_t>(columns.size() - before);
        }
    });
    std::vector<std::uint32_t> columns;
    for (const std::vector<std::uint32_t>& part : parts) columns.insert(columns.end(), part.begin(), part.end());
    for (std::size_t row = 0; row < rows(); ++row) first[row + 1] += first[row];
    matrix.shape(std::move(first), std::move(columns));
}

template <class Real>
void Hessian<Real>::assemble(Energy<Real>& energy, const std::vector<Real>& state, Curvature curvature,
                             BlockMatrix& matrix) {
    const std::size_t build = energy.neighbours().builds() + energy.friction().renewals();
    if (m_shape_of_build != build || matrix.rows() != rows()) {
        make_shape(energy, matrix);
        m_shape_of_build = build;
    } else {
        matrix.clear_values();
    }
    const FabricView<Real> fabric = energy.view(state);
    for (const std::vector<Chunk>& colour : m_chunks) {
        energy.executor().each(colour.size(), [&](std::size_t c) {
            Scratch scratch;
            for (std::uint32_t s = colour[c].first; s < colour[c].last; ++s)
                add_segment(energy, fabric, s, curvature == Curvature::convex, matrix, scratch);
        });
    }
    if (!energy.transition().is_on()) return;
    for (const auto& [segment, blocks] : energy.transition().curvature(fabric)) {
        const std::uint32_t slot = fabric.segments[segment].slot;
        scatter(slot, slot, blocks, matrix);
    }
}

template <class Real>
void Hessian<Real>::add_segment(Energy<Real>& energy, const FabricView<Real>& fabric, std::uint32_t index,
                                bool convex, BlockMatrix& matrix, Scratch& scratch) const {
    const SegmentPlace& segment = fabric.segments[index];
    const YarnConstants<double>& yarn = m_constants[segment.yarn];
    for (std::size_t k = 0; k < 12; ++k)
        scratch.slots[k] = static_cast<double>(fabric.place[3 * std::size_t(segment.slot) + k]);
    scratch.own.clear();
    const Speeds<double> speeds(m_gauss, scratch.slots);
    add_stretch_curvature(yarn, m_gauss, speeds, convex, scratch.own);
    add_bending_curvature(yarn, m_gauss, scratch.slots, speeds, convex, scratch.own);
    if (!m_spheres.empty()) add_field_curvature(yarn, m_gauss, scratch.slots, m_spheres, convex, scratch.own);

    const std::uint32_t first_near = m_first_near[index], near = m_first_near[index + 1] - first_near;
    if (scratch.other.size() < near) scratch.other.resize(near);
    scratch.touched.assign(near, 0);
    for (std::uint32_t k = 0; k < yarn.samples; ++k)
        add_sample(energy.neighbours(), fabric, index, k, convex, scratch);
    for (std::uint32_t k = 0; energy.friction().is_on() && k < yarn.samples; ++k)
        add_friction(energy, fabric, index, k, scratch);
    scatter(segment.slot, segment.slot, scratch.own, matrix);
    for (std::uint32_t n = 0; n < near; ++n) {
        if (scratch.touched[n] != 0)
            scatter(segment.slot, fabric.segments[m_near[first_near + n]].slot, scratch.other[n], matrix);
    }
}

/// What contact adds at one sample. Its weight w = α|T| depends on the tangent T, with unit t: each pair's energy
/// w_a w_b f(u) has derivatives by both places and, when exact, by both tangents.
template <class Real>
void Hessian<Real>::add_sample(const Neighbours<Real>& neighbours, const FabricView<Real>& fabric, std::uint32_t index,
                               std::uint32_t k, bool convex, Scratch& scratch) const {
    const SegmentPlace& segment = fabric.segments[index];
    const YarnConstants<double>& yarn = m_constants[segment.yarn];
    const Basis<double>& mine = m_bases[yarn.basis + k];
    const std::uint32_t a = segment.sample + k;
    const SamplesView<Real>& all = fabric.samples;
    const Vec<double> tangent = combine(mine.slope, scratch.slots);
    const double speed = guarded(tangent.norm(), yarn), weight = static_cast<double>(all.weight[a]);
    const double share = yarn.root_k / yarn.samples;
    const Vec<double> pull = share / speed * tangent;  // ∂w/∂T
    Mat<double> by_place = Mat<double>::Zero();
    Vec<double> slope = Vec<double>::Zero();
    double spread = 0;
    for (std::uint32_t e = fabric.first_neighbour[a]; e < fabric.first_neighbour[a + 1]; ++e) {
        const std::uint32_t b = fabric.neighbours[e];
        const Vec<double> u(static_cast<double>(all.x[a] - all.x[b]), static_cast<double>(all.y[a] - all.y[b]),
                            static_cast<double>(all.z[a] - all.z[b]));
        const double reach = static_cast<double>(all.radius[a] + all.radius[b]);
        if (u.squaredNorm() >= reach * reach) continue;
        const PairCurvature pair = pair_curvature(u, reach * reach, static_cast<double>(fabric.floor), convex);
        const double other_weight = static_cast<double>(all.weight[b]);
        by_place += other_weight * pair.by_place;
        slope += other_weight * pair.slope;
        spread += other_weight * pair.value;
        const std::uint32_t own = neighbours.own(b), other = neighbours.segment_of(own);
        const SegmentPlace& place = fabric.segments[other];
        const YarnConstants<double>& other_yarn = m_constants[place.yarn];
        const Basis<double>& theirs = m_bases[other_yarn.basis + (own - place.sample)];
        SlotBlocks& sum = other_sum(index, other, scratch);
        sum.add(mine.value, theirs.value, -weight * other_weight * pair.by_place);
        if (convex) continue;
        const Real* slots = fabric.place + 3 * std::size_t(place.slot);
        const Vec<double> other_tangent =
            theirs.slope[0] * load(slots).template cast<double>() + theirs.slope[1] * load(slots + 3).template cast<double>() +
            theirs.slope[2] * load(slots + 6).template cast<double>() + theirs.slope[3] * load(slots + 9).template cast<double>();
        const Vec<double> other_pull = other_yarn.root_k / other_yarn.samples / guarded(other_tangent.norm(), other_yarn) * other_tangent;
        sum.add(mine.value, theirs.slope, weight * pair.slope * other_pull.transpose());
        sum.add(mine.slope, theirs.value, -other_weight * pull * pair.slope.transpose());
        sum.add(mine.slope, theirs.slope, pair.value * pull * other_pull.transpose());
    }
    if (spread == 0) return;
    scratch.own.add(mine.value, mine.value, weight * by_place);
    scratch.own.add(mine.slope, mine.slope, across(tangent / speed) * (share * spread / speed));
    if (convex) return;
    const Mat<double> mixed = slope * pull.transpose();
    scratch.own.add(mine.value, mine.slope, mixed);
    scratch.own.add(mine.slope, mine.value, mixed.transpose());
}

/// What held friction adds at one sample; it is convex as it is.
template <class Real>
void Hessian<Real>::add_friction(Energy<Real>& energy, const FabricView<Real>& fabric, std::uint32_t index,
                                 std::uint32_t k, Scratch& scratch) const {
    const SegmentPlace& segment = fabric.segments[index];
    const Basis<double>& mine = m_bases[m_constants[segment.yarn].basis + k];
    const std::uint32_t a = segment.sample + k;
    const FrictionView<Real> friction = energy.friction().view();
    for (std::uint32_t p = friction.first[a]; p < friction.first[a + 1]; ++p) {
        const FrictionPair<Real>& pair = friction.pairs[p];
        const Mat<double> by_place =
            friction_curvature<Real>(pair, place_of(fabric.samples, a) - place_of(fabric.samples, pair.other));
        const std::uint32_t other = energy.neighbours().segment_of(pair.other);
        const SegmentPlace& place = fabric.segments[other];
        const Basis<double>& theirs = m_bases[m_constants[place.yarn].basis + (pair.other - place.sample)];
        scratch.own.add(mine.value, mine.value, by_place);
        other_sum(index, other, scratch).add(mine.value, theirs.value, -by_place);
    }
}

template <class Real>
SlotBlocks& Hessian<Real>::other_sum(std::uint32_t index, std::uint32_t other, Scratch& scratch) const {
    const auto begin = m_near.begin() + m_first_near[index], end = m_near.begin() + m_first_near[index + 1];
    const auto at = static_cast<std::size_t>(std::lower_bound(begin, end, other) - begin);
    if (scratch.touched[at] == 0) scratch.other[at].clear();
    scratch.touched[at] = 1;
    return scratch.other[at];
}

/// The columns of a segment's slots mostly follow one another, and so do their blocks: one search a row then serves all.
template <class Real>
void Hessian<Real>::scatter(std::uint32_t slot, std::uint32_t other_slot, const SlotBlocks& local,
                            BlockMatrix& matrix) const {
    for (std::uint32_t c = 0; c < 4; ++c) {
        for (std::uint32_t i = m_first_share[slot + c]; i < m_first_share[slot + c + 1]; ++i) {
            const std::uint32_t row = m_shares[i].row;
            const std::size_t end = matrix.first(row + 1);
            std::size_t at = end;
            for (std::uint32_t d = 0; d < 4; ++d) {
                for (std::uint32_t j = m_first_share[other_slot + d]; j < m_first_share[other_slot + d + 1]; ++j) {
                    const std::uint32_t column = m_shares[j].row;
                    if (++at >= end || matrix.column(at) != column) at = matrix.find(row, column);
                    float* block = matrix.value(at);
                    const double weight = double(m_shares[i].weight) * double(m_shares[j].weight);
                    const double* from = local.block[4 * c + d];
                    for (int k = 0; k < 9; ++k) block[k] += static_cast<float>(weight * from[k]);
                }
            }
        }
    }
}

template <class Real>
void Hessian<Real>::to_rows(const std::vector<Real>& slots, std::vector<double>& rows) const {
    rows.resize(3 * m_slot_of_row.size());
    for (std::size_t row = 0; row < m_slot_of_row.size(); ++row) {
        for (std::size_t k = 0; k < 3; ++k) rows[3 * row + k] = static_cast<double>(slots[3 * m_slot_of_row[row] + k]);
    }
}

template <class Real>
void Hessian<Real>::to_slots(const std::vector<double>& rows, std::vector<Real>& slots) const {
    slots.assign(3 * m_fabric.slots(), 0);
    for (std::size_t row = 0; row < m_slot_of_row.size(); ++row) {
        for (std::size_t k = 0; k < 3; ++k) slots[3 * m_slot_of_row[row] + k] = static_cast<Real>(rows[3 * row + k]);
    }
    m_fabric.follow_change(slots);
}

template class Hessian<float>;
template class Hessian<double>;

}  // namespace weave::sim
