#include <weave/sim/device/piece_arrays.hpp>

#include <algorithm>
#include <stdexcept>

namespace weave::sim {

template <class Real>
PieceArrays<Real>::PieceArrays(Memory& memory, const Hierarchy& hierarchy)
    : m_level(memory), m_level_of(memory), m_first_member(memory), m_first_target(memory), m_member(memory), m_target(memory),
      m_first(memory), m_column(memory), m_diagonal(memory), m_start(memory), m_count(memory), m_found(memory), m_value(memory),
      m_inverse(memory), m_residual(memory), m_step(memory), m_whole(memory), m_spare_whole(memory), m_needed(memory, 1) {
    number_levels(hierarchy.levels());
    lay_shares(memory, hierarchy.levels());
    const PieceDepths& depths = m_view.depths;
    std::size_t widest = 0, whole = 0, largest = 0;
    for (std::uint32_t d = 1; d <= depths.depths; ++d) widest = std::max<std::size_t>(widest, depths.pieces_at(d));
    for (std::size_t w = 0; w < depths.wholes; ++w) {
        const std::size_t size = 3 * std::size_t{depths.whole[w].end - depths.whole[w].first};
        whole += size * size;
        largest = std::max(largest, size * size);
    }
    m_first.resize(std::size_t{depths.pieces()} + 1);
    m_diagonal.resize(depths.pieces());
    m_start.resize(widest + 1);
    m_count.resize(widest + 1);
    m_inverse.resize(9 * (std::size_t{depths.rows} + depths.pieces()));
    m_residual.resize(3 * std::size_t{depths.pieces()});
    m_step.resize(3 * std::size_t{depths.pieces()});
    m_whole.resize(whole);
    m_spare_whole.resize(largest);
    lay();
}

/// Gives the levels their depths and their pieces numbers, by rising depth.
template <class Real>
void PieceArrays<Real>::number_levels(const std::vector<PieceLevel>& levels) {
    PieceDepths& depths = m_view.depths;
    depths.rows = static_cast<std::uint32_t>(levels.front().rows);
    m_first_piece.assign(levels.size(), 0);
    std::uint32_t pieces = 0, whole_numbers = 0;
    const auto add_whole = [&](std::uint32_t first, std::size_t rows) {
        if (depths.wholes == most_whole) throw std::length_error("PieceArrays: too many levels end");
        depths.whole[depths.wholes++] = {first, first + static_cast<std::uint32_t>(rows), 1, whole_numbers};
        whole_numbers += static_cast<std::uint32_t>(9 * rows * rows);
    };
    m_order = {0};
    if (levels.front().coarser.empty()) add_whole(0, levels.front().rows);
    for (std::size_t begin = 0; begin < m_order.size();) {
        const std::size_t end = m_order.size();
        for (std::size_t i = begin; i < end; ++i) {
            for (const std::size_t next : levels[m_order[i]].coarser) {
                m_first_piece[next] = pieces;
                pieces += static_cast<std::uint32_t>(levels[next].rows);
                if (levels[next].coarser.empty()) add_whole(m_first_piece[next], levels[next].rows);
                m_order.push_back(next);
            }
        }
        begin = end;
        if (m_order.size() == end) break;
        if (depths.depths == most_depths) throw std::length_error("PieceArrays: too many depths");
        depths.first[++depths.depths] = pieces;
    }
}

template <class Real>
void PieceArrays<Real>::lay_shares(Memory& memory, const std::vector<PieceLevel>& levels) {
    std::vector<PieceRange> ranges;
    std::vector<std::uint32_t> level_of, first_member{0}, first_target{0};
    std::vector<PieceShare<Real>> members, targets;
    std::vector<std::size_t> finer(levels.size(), 0);
    for (std::size_t l = 0; l < levels.size(); ++l) {
        for (const std::size_t next : levels[l].coarser) finer[next] = l;
    }
    for (const std::size_t number : m_order) {
        const PieceLevel& level = levels[number];
        for (std::size_t row = 0; row < level.rows; ++row) {
            for (const std::size_t next : level.coarser) {
                const PieceShares& shares = levels[next].shares[row];
                for (std::size_t k = 0; k < 4; ++k) {
                    if (shares.weight[k] != 0)
                        targets.push_back({m_first_piece[next] + shares.of[k], static_cast<Real>(shares.weight[k])});
                }
            }
            first_target.push_back(static_cast<std::uint32_t>(targets.size()));
        }
        if (number == 0) continue;
        const std::uint32_t shift = finer[number] == 0 ? 0 : m_first_piece[finer[number]];
        for (std::size_t piece = 0; piece < level.rows; ++piece) {
            level_of.push_back(static_cast<std::uint32_t>(ranges.size()));
            for (std::uint32_t m = level.first_member[piece]; m < level.first_member[piece + 1]; ++m)
                members.push_back({shift + level.members[m], static_cast<Real>(level.member_weight[m])});
            first_member.push_back(static_cast<std::uint32_t>(members.size()));
        }
        PieceRange range{m_first_piece[number], m_first_piece[number] + static_cast<std::uint32_t>(level.rows), 0, 0};
        for (std::size_t w = 0; w < m_view.depths.wholes; ++w) {
            if (level.coarser.empty() && m_view.depths.whole[w].first == range.first) range = m_view.depths.whole[w];
        }
        ranges.push_back(range);
    }
    m_level = Array<PieceRange>(memory, ranges);
    m_level_of = Array<std::uint32_t>(memory, level_of);
    m_first_member = Array<std::uint32_t>(memory, first_member);
    m_first_target = Array<std::uint32_t>(memory, first_target);
    m_member = Array<PieceShare<Real>>(memory, members);
    m_target = Array<PieceShare<Real>>(memory, targets);
}

template <class Real>
void PieceArrays<Real>::grow() {
    const PiecesNeeds needs = m_needed.get().front();
    if (needs.found > m_found.size()) m_found.resize(needs.found + needs.found / 8);
    if (needs.blocks > m_column.size()) {
        m_column.resize(needs.blocks + needs.blocks / 8);
        m_value.resize(9 * m_column.size());
    }
    lay();
}

template <class Real>
void PieceArrays<Real>::lay() {
    m_view.level = m_level.view();
    m_view.level_of = m_level_of.view();
    m_view.first_member = m_first_member.view();
    m_view.member = m_member.view();
    m_view.first_target = m_first_target.view();
    m_view.target = m_target.view();
    m_view.matrix = {m_view.depths.pieces(), m_first.view(), m_column.view(), m_diagonal.view(), m_value.view()};
    m_view.inverse = m_inverse.view();
    m_view.whole = m_whole.view();
    m_view.spare_whole = m_spare_whole.view();
    m_view.residual = m_residual.view();
    m_view.step = m_step.view();
    m_view.start = m_start.view();
    m_view.count = m_count.view();
    m_view.found = m_found.view();
    m_view.room = {m_column.size(), m_found.size()};
    m_view.needed = m_needed.view();
}

template <class Real>
std::size_t PieceArrays<Real>::bytes() const {
    return m_level.bytes() + m_level_of.bytes() + m_first_member.bytes() + m_first_target.bytes() + m_member.bytes() + m_target.bytes() +
           m_first.bytes() + m_column.bytes() + m_diagonal.bytes() + m_start.bytes() + m_count.bytes() + m_found.bytes() +
           m_value.bytes() + m_inverse.bytes() + m_residual.bytes() + m_step.bytes() + m_whole.bytes() + m_spare_whole.bytes() +
           m_needed.bytes();
}

template class PieceArrays<float>;
template class PieceArrays<double>;

}  // namespace weave::sim
