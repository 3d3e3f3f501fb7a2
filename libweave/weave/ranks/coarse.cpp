#include <weave/ranks/coarse.hpp>

#include <algorithm>
#include <cmath>
#include <map>

namespace weave::ranks {

namespace {

constexpr std::size_t nodes_a_block = 2;  ///< along each axis
constexpr std::size_t numbers_a_sum = 11;  ///< two nodes and a block of nine

}  // namespace

CoarseGrid::CoarseGrid(Comm& comm, const Cut& cut, const std::vector<Part>& parts) : m_comm(comm), m_low(cut.low) {
    for (std::size_t k = 0; k < 2; ++k) {
        m_is_closed[k] = cut.terms.is_periodic[k] && cut.terms.period_mm[k] > 0;
        m_nodes[k] = nodes_a_block * cut.blocks[k] + (m_is_closed[k] ? 0 : 1);
        const double size = m_is_closed[k] ? cut.terms.period_mm[k] : std::max(1e-9, cut.high[k] - cut.low[k]);
        m_step[k] = size / static_cast<double>(nodes_a_block * cut.blocks[k]);
    }
    std::vector<double> told;
    for (const Part& part : parts) {
        Block& block = m_blocks.emplace_back();
        for (const Point& point : part.own) {
            if (!cut.moves(point)) continue;
            block.rows.push_back(shares_of(point));
            block.nodes.insert(block.nodes.end(), block.rows.back().node.begin(), block.rows.back().node.end());
        }
        std::sort(block.nodes.begin(), block.nodes.end());
        block.nodes.erase(std::unique(block.nodes.begin(), block.nodes.end()), block.nodes.end());
        told.insert(told.end(), block.nodes.begin(), block.nodes.end());
    }
    for (const Comm::Packet& nodes : comm.gather(told)) {
        m_counts.push_back(3 * nodes.size());
        for (const double node : nodes) m_nodes_told.push_back(static_cast<std::uint32_t>(node));
    }
}

CoarseGrid::Shares CoarseGrid::shares_of(const Point& point) const {
    Shares shares;
    std::array<std::array<std::size_t, 2>, 2> node{};
    std::array<double, 2> over{};
    for (std::size_t k = 0; k < 2; ++k) {
        const double at = (point.planned[static_cast<Eigen::Index>(k)] - m_low[k]) / m_step[k], most = static_cast<double>(m_nodes[k]);
        // A closed axis goes on from its last node to its first; an open one ends at its last.
        const double below = m_is_closed[k] ? std::floor(at) : std::clamp(std::floor(at), 0.0, most - 2);
        over[k] = std::clamp(at - below, 0.0, 1.0);
        const double wrapped = below - most * std::floor(below / most);
        node[k] = {static_cast<std::size_t>(wrapped), (static_cast<std::size_t>(wrapped) + 1) % m_nodes[k]};
    }
    for (std::size_t c = 0; c < 4; ++c) {
        const std::size_t i = c % 2, j = c / 2;
        shares.node[c] = static_cast<std::uint32_t>(node[0][i] * m_nodes[1] + node[1][j]);
        shares.weight[c] = (i == 0 ? 1 - over[0] : over[0]) * (j == 0 ? 1 - over[1] : over[1]);
    }
    return shares;
}

void CoarseGrid::factor(const std::vector<std::unique_ptr<Piece>>& pieces, const std::vector<Part>& parts) {
    Comm::Packet told;
    for (std::size_t b = 0; b < pieces.size(); ++b) {
        const Piece& piece = *pieces[b];
        std::vector<Shares> of_row(piece.matrix.rows());
        std::vector<std::uint32_t> own_rows;
        for (std::size_t i = 0; i < parts[b].own.size(); ++i) {
            const std::uint32_t row = piece.row_of_own()[i];
            if (row == Piece::none) continue;
            of_row[row] = m_blocks[b].rows[own_rows.size()];
            own_rows.push_back(row);
        }
        for (std::size_t g = 0; g < piece.guests().size(); ++g) {
            if (piece.row_of_guest()[g] != Piece::none) of_row[piece.row_of_guest()[g]] = shares_of(piece.guests()[g].point);
        }
        std::map<std::array<std::uint32_t, 2>, std::array<double, 9>> sums;
        for (const std::uint32_t row : own_rows) {
            for (std::uint32_t at = piece.matrix.first(row); at < piece.matrix.first(row + 1); ++at) {
                const float* block = piece.matrix.value(at);
                const Shares &mine = of_row[row], &theirs = of_row[piece.matrix.column(at)];
                for (std::size_t c = 0; c < 4; ++c) {
                    for (std::size_t d = 0; d < 4; ++d) {
                        const double weight = mine.weight[c] * theirs.weight[d];
                        if (weight == 0 || mine.node[c] < theirs.node[d]) continue;
                        std::array<double, 9>& sum = sums[{mine.node[c], theirs.node[d]}];
                        for (std::size_t k = 0; k < 9; ++k) sum[k] += weight * static_cast<double>(block[k]);
                    }
                }
            }
        }
        for (const auto& [nodes, sum] : sums) {
            told.push_back(nodes[0]);
            told.push_back(nodes[1]);
            told.insert(told.end(), sum.begin(), sum.end());
        }
    }
    set_matrix(m_comm.gather(told));
}

/// Sums come block after block, whichever rank has them, and are added in that order.
void CoarseGrid::set_matrix(const std::vector<Comm::Packet>& sums) {
    std::vector<Eigen::Triplet<double>> entries;
    double trace = 0;
    for (const Comm::Packet& packet : sums) {
        for (std::size_t at = 0; at < packet.size(); at += numbers_a_sum) {
            const auto row = static_cast<int>(packet[at]), column = static_cast<int>(packet[at + 1]);
            for (int k = 0; k < 9; ++k) entries.emplace_back(3 * row + k % 3, 3 * column + k / 3, packet[at + 2 + static_cast<std::size_t>(k)]);
            if (row == column) trace += std::abs(packet[at + 2]) + std::abs(packet[at + 6]) + std::abs(packet[at + 10]);
        }
    }
    const auto size = static_cast<Eigen::Index>(3 * nodes());
    const double mean = std::max(1e-30, trace / static_cast<double>(size));
    double damping = 1e-6 * mean;
    do {
        std::vector<Eigen::Triplet<double>> damped = entries;
        for (int k = 0; k < size; ++k) damped.emplace_back(k, k, damping);
        Eigen::SparseMatrix<double> matrix(size, size);
        matrix.setFromTriplets(damped.begin(), damped.end());
        m_solver.compute(matrix);
        damping *= 8;
    } while (m_solver.info() != Eigen::Success && damping < 1e6 * mean);
}

void CoarseGrid::apply(std::span<const double> residual, std::span<double> step) {
    m_told.clear();
    std::size_t at = 0;
    for (const Block& block : m_blocks) {
        std::vector<double> sum(3 * block.nodes.size(), 0);
        for (const Shares& shares : block.rows) {
            for (std::size_t c = 0; c < 4; ++c) {
                const auto place = static_cast<std::size_t>(std::ranges::lower_bound(block.nodes, shares.node[c]) - block.nodes.begin());
                for (std::size_t k = 0; k < 3; ++k) sum[3 * place + k] += shares.weight[c] * residual[at + k];
            }
            at += 3;
        }
        m_told.insert(m_told.end(), sum.begin(), sum.end());
    }
    m_comm.gather(m_told, m_counts, m_all);
    m_right.assign(3 * nodes(), 0);
    for (std::size_t n = 0; n < m_nodes_told.size(); ++n) {
        for (std::size_t k = 0; k < 3; ++k) m_right[3 * m_nodes_told[n] + k] += m_all[3 * n + k];
    }
    const auto size = static_cast<Eigen::Index>(m_right.size());
    const Eigen::VectorXd found = m_solver.solve(Eigen::Map<const Eigen::VectorXd>(m_right.data(), size));
    at = 0;
    for (const Block& block : m_blocks) {
        for (const Shares& shares : block.rows) {
            for (std::size_t c = 0; c < 4; ++c) {
                for (std::size_t k = 0; k < 3; ++k)
                    step[at + k] += shares.weight[c] * found[static_cast<Eigen::Index>(3 * shares.node[c] + k)];
            }
            at += 3;
        }
    }
}

}  // namespace weave::ranks
