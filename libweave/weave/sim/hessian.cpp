#include <weave/sim/hessian.hpp>

#include <weave/sim/hessian_terms.hpp>

#include <algorithm>

namespace weave::sim {

namespace {

constexpr std::uint32_t chunk_segments = 32;
constexpr std::uint32_t no_row = 0xffffffffU;

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
    bool convex = true;
};

/// What one sample meets of one other segment, by that segment's slots: what its place feels, and what its tangent does.
template <class Real>
struct Hessian<Real>::Meeting {
    std::uint32_t segment = 0xffffffffU;
    double rows_by_place[4], rows_by_tangent[4];  ///< of the sample's own slots
    Vec<double> pull;                             ///< of the sample
    ColumnBlocks by_place;
    Vec<double> by_tangent[4];

    void begin(std::uint32_t other) {
        segment = other;
        by_place.clear();
        for (Vec<double>& sum : by_tangent) sum.setZero();
    }
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
    m_end_of_yarn.resize(m_slot_of_row.size());
    for (std::size_t row = m_slot_of_row.size(); row-- > 0;) {
        const bool is_last = row + 1 == m_slot_of_row.size() || m_fabric.yarn_of_slot()[m_slot_of_row[row]] !=
                                                                     m_fabric.yarn_of_slot()[m_slot_of_row[row + 1]];
        m_end_of_yarn[row] = is_last ? static_cast<std::uint32_t>(row + 1) : m_end_of_yarn[row + 1];
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
    m_first_row.assign(m_fabric.segments(), no_row);
    for (std::size_t s = 0; s < m_fabric.segments(); ++s) {
        const std::uint32_t slot = m_fabric.segment_places()[s].slot;
        bool follow = true;
        for (std::uint32_t c = 0; c < 4; ++c)
            follow = follow && moves[slot + c] != 0 && row_of_slot[slot + c] == row_of_slot[slot] + c;
        if (follow) m_first_row[s] = row_of_slot[slot];
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
    const bool rubs = energy.friction().is_on();
    constexpr std::size_t at_once = 256;
    std::vector<std::vector<std::uint32_t>> parts((m_fabric.segments() + at_once - 1) / at_once);
    m_first_near.assign(m_fabric.segments() + 1, 0);
    energy.executor().each(parts.size(), [&](std::size_t part) {
        std::vector<std::uint32_t>& near = parts[part];
        for (std::size_t s = part * at_once; s < std::min(m_fabric.segments(), (part + 1) * at_once); ++s) {
            const SegmentPlace& segment = m_fabric.segment_places()[s];
            const std::size_t before = near.size();
            const std::uint32_t* first = neighbours.first() + segment.sample;
            const std::uint32_t samples = m_fabric.constants()[segment.yarn].samples;
            for (std::uint32_t e = first[0]; e < first[samples]; ++e) {
                const std::uint32_t other = neighbours.segment_of(neighbours.own(neighbours.others()[e]));
                // Neighbours of one segment follow one another.
                if (near.size() == before || near.back() != other) near.push_back(other);
            }
            for (std::uint32_t p = rubs ? rubbing.first[segment.sample] : 0,
                               end = rubs ? rubbing.first[segment.sample + samples] : 0;
                 p < end; ++p)
                near.push_back(neighbours.segment_of(rubbing.pairs[p].other));
            const auto begin = near.begin() + static_cast<std::ptrdiff_t>(before);
            std::sort(begin, near.end());
            near.erase(std::unique(begin, near.end()), near.end());
            m_first_near[s + 1] = static_cast<std::uint32_t>(near.size() - before);
        }
    });
    for (std::size_t s = 0; s < m_fabric.segments(); ++s) m_first_near[s + 1] += m_first_near[s];
    m_near.clear();
    for (const std::vector<std::uint32_t>& part : parts) m_near.insert(m_near.end(), part.begin(), part.end());
}

/// The rows that a control point meets, some of them more than once: those of its own segments, and of the segments
/// near to these.
template <class Real>
void Hessian<Real>::list_columns(std::uint32_t row, std::vector<std::uint32_t>& columns) const {
    // The next segment of a yarn has three rows of the last one. Rows that are shared say nothing of those before them: where a
    // periodic yarn is held in part, its first segment may have a share in its last row alone.
    std::uint32_t listed = 0;  // the row after those of the last segment that has rows of its own
    const auto add_slots = [&](std::uint32_t segment) {
        const std::uint32_t first = m_first_row[segment];
        if (first == no_row) {
            const std::uint32_t slot = m_fabric.segment_places()[segment].slot;
            for (std::uint32_t j = m_first_share[slot]; j < m_first_share[slot + 4]; ++j) columns.push_back(m_shares[j].row);
            return;
        }
        for (std::uint32_t column = std::max(first, listed); column < first + 4; ++column) columns.push_back(column);
        listed = first + 4;
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
    list_mirrored(matrix);
}

/// Rows rise, and so do the columns of each: the next block of a row that is mirrored is that of the next row that has
/// one for it.
template <class Real>
void Hessian<Real>::list_mirrored(const BlockMatrix& matrix) {
    std::vector<std::uint32_t> next(rows());
    m_first_mirrored.resize(rows());
    for (std::uint32_t row = 0; row < rows(); ++row)
        m_first_mirrored[row] = next[row] = static_cast<std::uint32_t>(matrix.find(row, m_end_of_yarn[row]));
    m_mirrored_from.resize(matrix.blocks());
    for (std::uint32_t row = 0; row < rows(); ++row) {
        for (std::uint32_t at = matrix.first(row); at < matrix.first(row + 1); ++at) {
            const std::uint32_t column = matrix.column(at);
            if (m_end_of_yarn[column] > row) break;  // its own yarn
            m_mirrored_from[next[column]++] = at;
        }
    }
}

template <class Real>
void Hessian<Real>::mirror(const Executor& executor, BlockMatrix& matrix) const {
    executor.each(rows(), [&](std::size_t row) {
        for (std::uint32_t at = m_first_mirrored[row]; at < matrix.first(row + 1); ++at) {
            const float* from = matrix.value(m_mirrored_from[at]);
            float* to = matrix.value(at);
            for (int i = 0; i < 3; ++i) {
                for (int j = 0; j < 3; ++j) to[3 * j + i] = from[3 * i + j];
            }
        }
    });
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
    const bool convex = curvature == Curvature::convex;
    if (!convex) lay_pulls(energy.executor(), fabric);
    for (const std::vector<Chunk>& colour : m_chunks) {
        energy.executor().each(colour.size(), [&](std::size_t c) {
            Scratch scratch;
            scratch.convex = convex;
            run_wide(
                [&](std::size_t s) __attribute__((always_inline)) {
                    add_segment(energy, fabric, static_cast<std::uint32_t>(s), matrix, scratch);
                },
                colour[c].first, colour[c].last);
        });
    }
    mirror(energy.executor(), matrix);
    if (!energy.transition().is_on()) return;
    for (const auto& [segment, blocks] : energy.transition().curvature(fabric)) scatter(segment, segment, blocks, matrix);
}

template <class Real>
inline void Hessian<Real>::add_segment(Energy<Real>& energy, const FabricView<Real>& fabric, std::uint32_t index,
                                           BlockMatrix& matrix, Scratch& scratch) const {
    const SegmentPlace& segment = fabric.segments[index];
    const YarnConstants<double>& yarn = m_constants[segment.yarn];
    for (std::size_t k = 0; k < 12; ++k)
        scratch.slots[k] = static_cast<double>(fabric.place[3 * std::size_t(segment.slot) + k]);
    scratch.own.clear();
    const bool convex = scratch.convex;
    const Speeds<double> speeds(m_gauss, scratch.slots);
    GaussBlocks elastic;
    elastic.clear();
    add_stretch_curvature(yarn, m_gauss, speeds, static_cast<double>(fabric.give), convex, elastic);
    add_bending_curvature(yarn, m_gauss, scratch.slots, speeds, convex, elastic);
    elastic.add_to(scratch.own, m_gauss);
    if (!m_spheres.empty()) add_field_curvature(yarn, m_gauss, scratch.slots, m_spheres, convex, scratch.own);

    const std::uint32_t first_near = m_first_near[index], near = m_first_near[index + 1] - first_near;
    if (scratch.other.size() < near) scratch.other.resize(near);
    scratch.touched.assign(near, 0);
    for (std::uint32_t k = 0; k < yarn.samples; ++k)
        add_sample(energy.neighbours(), fabric, index, k, scratch);
    for (std::uint32_t k = 0; energy.friction().is_on() && k < yarn.samples; ++k)
        add_friction(energy, fabric, index, k, scratch);
    scatter(index, index, scratch.own, matrix);
    for (std::uint32_t n = 0; n < near; ++n) {
        if (scratch.touched[n] != 0)
            scatter(index, m_near[first_near + n], scratch.other[n], matrix);
    }
}

/// ∂w/∂T of every contact sample, w = α|T| being its weight.
template <class Real>
void Hessian<Real>::lay_pulls(const Executor& executor, const FabricView<Real>& fabric) {
    m_pulls.resize(m_fabric.samples());
    executor.each(m_fabric.segments(), [&](std::size_t index) {
        const SegmentPlace& segment = fabric.segments[index];
        const YarnConstants<double>& yarn = m_constants[segment.yarn];
        double slots[12];
        for (std::size_t k = 0; k < 12; ++k)
            slots[k] = static_cast<double>(fabric.place[3 * std::size_t(segment.slot) + k]);
        for (std::uint32_t k = 0; k < yarn.samples; ++k) {
            const Vec<double> tangent = combine(m_bases[yarn.basis + k].slope, slots);
            m_pulls[segment.sample + k] = yarn.root_k / yarn.samples / guarded(tangent.norm(), yarn) * tangent;
        }
    });
}

/// What contact adds at one sample. Its weight w = α|T| depends on the tangent T, with unit t: each pair's energy
/// w_a w_b f(u) has derivatives by both places and, when exact, by both tangents. Blocks between two yarns are made for
/// the one of higher number and mirrored. Neighbours of one segment follow one another.
template <class Real>
inline void Hessian<Real>::add_sample(const Neighbours<Real>& neighbours, const FabricView<Real>& fabric, std::uint32_t index,
                               std::uint32_t k, Scratch& scratch) const {
    const SegmentPlace& segment = fabric.segments[index];
    const YarnConstants<double>& yarn = m_constants[segment.yarn];
    const Basis<double>& mine = m_bases[yarn.basis + k];
    const std::uint32_t a = segment.sample + k;
    const SamplesView<Real>& all = fabric.samples;
    const Vec<double> tangent = combine(mine.slope, scratch.slots);
    const double speed = guarded(tangent.norm(), yarn), weight = static_cast<double>(all.weight[a]);
    const double share = yarn.root_k / yarn.samples;
    const bool convex = scratch.convex;
    Meeting meeting;
    meeting.pull = share / speed * tangent;  // ∂w/∂T
    for (int c = 0; c < 4; ++c) {
        meeting.rows_by_place[c] = weight * mine.value[c];
        meeting.rows_by_tangent[c] = mine.slope[c];
    }
    const double floor = static_cast<double>(fabric.floor);
    Nine by_place{};
    Vec<double> slope(0, 0, 0);
    double spread = 0;
    for (std::uint32_t e = fabric.first_neighbour[a]; e < fabric.first_neighbour[a + 1]; ++e) {
        const std::uint32_t b = fabric.neighbours[e];
        const Vec<double> u(static_cast<double>(all.x[a] - all.x[b]), static_cast<double>(all.y[a] - all.y[b]),
                            static_cast<double>(all.z[a] - all.z[b]));
        const double reach = static_cast<double>(all.radius[a] + all.radius[b]), square = u.squaredNorm();
        if (square >= reach * reach) continue;
        const PairCurvature<double> pair = pair_curvature(square, reach * reach, floor, convex);
        const double other_weight = static_cast<double>(all.weight[b]);
        const Nine pair_by_place = Nine::along(other_weight * pair.side, other_weight * pair.along, u);
        by_place += pair_by_place;
        slope += other_weight * pair.pull * u;
        spread += other_weight * pair.value;
        const std::uint32_t own = neighbours.own(b), other = neighbours.segment_of(own);
        const SegmentPlace& place = fabric.segments[other];
        if (place.yarn > segment.yarn) continue;
        if (other != meeting.segment) {
            add_meeting(index, meeting, scratch);
            meeting.begin(other);
        }
        const Basis<double>& theirs = m_bases[m_constants[place.yarn].basis + (own - place.sample)];
        meeting.by_place.take(theirs.value, pair_by_place);
        if (convex) continue;
        const Vec<double>& other_pull = m_pulls[own];
        meeting.by_place.add(theirs.slope, Nine::outer(pair.pull * u, other_pull));
        const Vec<double> by_slope = pair.value * other_pull, by_value = other_weight * pair.pull * u;
        for (int d = 0; d < 4; ++d) meeting.by_tangent[d] += theirs.slope[d] * by_slope - theirs.value[d] * by_value;
    }
    if (spread == 0) return;
    add_meeting(index, meeting, scratch);
    // Its own slots: the weight's second derivative is across the tangent.
    const Vec<double> unit = tangent / speed;
    const double side = share * spread / speed;
    const Nine mixed = Nine::outer(slope, meeting.pull);
    for (double& number : by_place.at) number *= weight;
    ColumnBlocks of_value, of_slope;
    of_value.clear(), of_slope.clear();
    of_value.add(mine.value, by_place);
    of_slope.add(mine.slope, Nine::along(side, -side, unit));
    if (!convex) {
        of_value.add(mine.slope, mixed);
        of_slope.add(mine.value, mixed.transposed());
    }
    scratch.own.add({{mine.value, &of_value}, {mine.slope, &of_slope}});
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
        if (place.yarn > segment.yarn) continue;  // mirrored
        other_sum(index, other, scratch).add(mine.value, theirs.value, -by_place);
    }
}

template <class Real>
inline SlotBlocks& Hessian<Real>::other_sum(std::uint32_t index, std::uint32_t other, Scratch& scratch) const {
    const auto begin = m_near.begin() + m_first_near[index], end = m_near.begin() + m_first_near[index + 1];
    const auto at = static_cast<std::size_t>(std::lower_bound(begin, end, other) - begin);
    if (scratch.touched[at] == 0) scratch.other[at].clear();
    scratch.touched[at] = 1;
    return scratch.other[at];
}

template <class Real>
inline void Hessian<Real>::add_meeting(std::uint32_t index, const Meeting& meeting, Scratch& scratch) const {
    if (meeting.segment >= m_fabric.segments()) return;
    SlotBlocks& sum = other_sum(index, meeting.segment, scratch);
    if (scratch.convex) return sum.add({{meeting.rows_by_place, &meeting.by_place}});
    ColumnBlocks by_tangent;
    by_tangent.clear();
    for (int d = 0; d < 4; ++d) {
        const Nine both = Nine::outer(meeting.pull, meeting.by_tangent[d]);
        for (int k = 0; k < 9; ++k) by_tangent.block[9 * d + k] = both.at[k];
    }
    sum.add({{meeting.rows_by_place, &meeting.by_place}, {meeting.rows_by_tangent, &by_tangent}});
}

template <class Real>
inline void Hessian<Real>::scatter(std::uint32_t segment, std::uint32_t other, const SlotBlocks& local,
                            BlockMatrix& matrix) const {
    const std::uint32_t slot = m_fabric.segment_places()[segment].slot, other_slot = m_fabric.segment_places()[other].slot,
                        first_column = m_first_row[other];
    for (std::uint32_t c = 0; c < 4; ++c) {
        const double* from = &local.block[36 * c];
        for (std::uint32_t i = m_first_share[slot + c]; i < m_first_share[slot + c + 1]; ++i) {
            const std::uint32_t row = m_shares[i].row;
            const double weight = static_cast<double>(m_shares[i].weight);
            if (first_column != no_row) {
                float* block = matrix.value(matrix.find(row, first_column));  // the other three follow
                for (int k = 0; k < 36; ++k) block[k] += static_cast<float>(weight * from[k]);
                continue;
            }
            for (std::uint32_t d = 0; d < 4; ++d) {
                for (std::uint32_t j = m_first_share[other_slot + d]; j < m_first_share[other_slot + d + 1]; ++j) {
                    float* block = matrix.value(matrix.find(row, m_shares[j].row));
                    const double both = weight * static_cast<double>(m_shares[j].weight);
                    for (std::uint32_t k = 0; k < 9; ++k) block[k] += static_cast<float>(both * from[9 * d + k]);
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
