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
    Matrix12 own;
    std::vector<Matrix12> other;  ///< per near segment
    std::vector<std::uint8_t> touched;
    double slots[12];
};

template <class Real>
Hessian<Real>::Hessian(const Fabric<Real>& fabric) : m_fabric(fabric), m_gauss(as_double(fabric.gauss())) {
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
    m_first_near.assign(m_fabric.segments() + 1, 0);
    m_near.clear();
    std::vector<std::uint32_t> seen(m_fabric.segments(), 0xffffffffU);
    for (std::uint32_t s = 0; s < m_fabric.segments(); ++s) {
        const SegmentPlace& segment = m_fabric.segment_places()[s];
        const std::size_t begin = m_near.size();
        for (std::uint32_t k = 0; k < m_fabric.constants()[segment.yarn].samples; ++k) {
            const std::uint32_t* first = neighbours.first() + segment.sample + k;
            for (std::uint32_t e = first[0]; e < first[1]; ++e) {
                const std::uint32_t other = neighbours.segment_of(neighbours.own(neighbours.others()[e]));
                if (seen[other] == s) continue;
                seen[other] = s;
                m_near.push_back(other);
            }
        }
        std::sort(m_near.begin() + static_cast<std::ptrdiff_t>(begin), m_near.end());
        m_first_near[s + 1] = static_cast<std::uint32_t>(m_near.size());
    }
}

template <class Real>
void Hessian<Real>::make_shape(Energy<Real>& energy, BlockMatrix& matrix) {
    list_near_segments(energy);
    std::vector<std::vector<std::uint32_t>> columns(rows());
    const auto connect = [&](std::uint32_t segment, std::uint32_t other) {
        const std::uint32_t a = m_fabric.segment_places()[segment].slot, b = m_fabric.segment_places()[other].slot;
        for (std::uint32_t i = m_first_share[a]; i < m_first_share[a + 4]; ++i) {
            for (std::uint32_t j = m_first_share[b]; j < m_first_share[b + 4]; ++j)
                columns[m_shares[i].row].push_back(m_shares[j].row);
        }
    };
    std::vector<std::uint32_t> first(1, 0), all;
    for (std::uint32_t s = 0; s < m_fabric.segments(); ++s) {
        connect(s, s);
        for (std::uint32_t n = m_first_near[s]; n < m_first_near[s + 1]; ++n) connect(s, m_near[n]);
    }
    for (std::vector<std::uint32_t>& of_row : columns) {
        std::sort(of_row.begin(), of_row.end());
        of_row.erase(std::unique(of_row.begin(), of_row.end()), of_row.end());
        all.insert(all.end(), of_row.begin(), of_row.end());
        first.push_back(static_cast<std::uint32_t>(all.size()));
        std::vector<std::uint32_t>().swap(of_row);
    }
    matrix.shape(std::move(first), std::move(all));
}

template <class Real>
void Hessian<Real>::assemble(Energy<Real>& energy, const std::vector<Real>& state, Curvature curvature,
                             BlockMatrix& matrix) {
    if (m_shape_of_build != energy.neighbours().builds() || matrix.rows() != rows()) {
        make_shape(energy, matrix);
        m_shape_of_build = energy.neighbours().builds();
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
}

template <class Real>
void Hessian<Real>::add_segment(Energy<Real>& energy, const FabricView<Real>& fabric, std::uint32_t index,
                                bool convex, BlockMatrix& matrix, Scratch& scratch) const {
    const SegmentPlace& segment = fabric.segments[index];
    const YarnConstants<double>& yarn = m_constants[segment.yarn];
    for (std::size_t k = 0; k < 12; ++k)
        scratch.slots[k] = static_cast<double>(fabric.place[3 * std::size_t(segment.slot) + k]);
    scratch.own.setZero();
    const Speeds<double> speeds(m_gauss, scratch.slots);
    add_stretch_curvature(yarn, m_gauss, speeds, convex, scratch.own);
    add_bending_curvature(yarn, m_gauss, scratch.slots, speeds, convex, scratch.own);

    const std::uint32_t first_near = m_first_near[index], near = m_first_near[index + 1] - first_near;
    if (scratch.other.size() < near) scratch.other.resize(near);
    scratch.touched.assign(near, 0);
    for (std::uint32_t k = 0; k < yarn.samples; ++k)
        add_sample(energy.neighbours(), fabric, index, k, convex, scratch);
    scatter(segment.slot, segment.slot, scratch.own.data(), matrix);
    for (std::uint32_t n = 0; n < near; ++n) {
        if (scratch.touched[n] != 0)
            scatter(segment.slot, fabric.segments[m_near[first_near + n]].slot, scratch.other[n].data(), matrix);
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
        Matrix12& sum = other_sum(index, other, scratch);
        add_product(mine.value, theirs.value, -weight * other_weight * pair.by_place, sum);
        if (convex) continue;
        const Real* slots = fabric.place + 3 * std::size_t(place.slot);
        const Vec<double> other_tangent =
            theirs.slope[0] * load(slots).template cast<double>() + theirs.slope[1] * load(slots + 3).template cast<double>() +
            theirs.slope[2] * load(slots + 6).template cast<double>() + theirs.slope[3] * load(slots + 9).template cast<double>();
        const Vec<double> other_pull = other_yarn.root_k / other_yarn.samples / guarded(other_tangent.norm(), other_yarn) * other_tangent;
        add_product(mine.value, theirs.slope, weight * pair.slope * other_pull.transpose(), sum);
        add_product(mine.slope, theirs.value, -other_weight * pull * pair.slope.transpose(), sum);
        add_product(mine.slope, theirs.slope, pair.value * pull * other_pull.transpose(), sum);
    }
    if (spread == 0) return;
    add_product(mine.value, mine.value, weight * by_place, scratch.own);
    add_product(mine.slope, mine.slope, across(tangent / speed) * (share * spread / speed), scratch.own);
    if (convex) return;
    const Mat<double> mixed = slope * pull.transpose();
    add_product(mine.value, mine.slope, mixed, scratch.own);
    add_product(mine.slope, mine.value, mixed.transpose(), scratch.own);
}

template <class Real>
Matrix12& Hessian<Real>::other_sum(std::uint32_t index, std::uint32_t other, Scratch& scratch) const {
    const auto begin = m_near.begin() + m_first_near[index], end = m_near.begin() + m_first_near[index + 1];
    const auto at = static_cast<std::size_t>(std::lower_bound(begin, end, other) - begin);
    if (scratch.touched[at] == 0) scratch.other[at].setZero();
    scratch.touched[at] = 1;
    return scratch.other[at];
}

template <class Real>
void Hessian<Real>::scatter(std::uint32_t slot, std::uint32_t other_slot, const double* local,
                            BlockMatrix& matrix) const {
    for (std::uint32_t c = 0; c < 4; ++c) {
        for (std::uint32_t i = m_first_share[slot + c]; i < m_first_share[slot + c + 1]; ++i) {
            for (std::uint32_t d = 0; d < 4; ++d) {
                for (std::uint32_t j = m_first_share[other_slot + d]; j < m_first_share[other_slot + d + 1]; ++j) {
                    float* block = matrix.value(matrix.find(m_shares[i].row, m_shares[j].row));
                    const float weight = m_shares[i].weight * m_shares[j].weight;
                    for (std::size_t column = 0; column < 3; ++column) {
                        for (std::size_t row = 0; row < 3; ++row)
                            block[3 * column + row] += weight * static_cast<float>(local[12 * (3 * d + column) + 3 * c + row]);
                    }
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
