#include <weave/sim/hierarchy.hpp>

#include <weave/curve/wrapped.hpp>

#include <algorithm>
#include <cmath>
#include <map>

namespace weave::sim {

namespace {

/// A piece spans so many pieces of the level before.
constexpr std::uint32_t span = 4;
/// Pieces of this level hand on to the grids: the shortest, for yarns that cross move alike only close to where they do.
constexpr std::size_t grids_from = 1;
constexpr double pieces_per_node = 6;

std::uint32_t pieces_of(std::uint32_t rows) {
    return rows <= span ? 1 : (rows + span / 2) / span;
}

}  // namespace

template <class Real>
std::vector<YarnRows> rows_of_yarns(const Fabric<Real>& fabric) {
    std::vector<YarnRows> all;
    std::uint32_t row = 0;
    for (std::size_t y = 0; y < fabric.yarns().size(); ++y) {
        const YarnPlace& yarn = fabric.yarns()[y];
        YarnRows mine{row, 0, false};
        for (std::uint32_t i = 0; i < yarn.points; ++i) mine.rows += fabric.moves()[yarn.first_slot + 1 + i];
        mine.is_closed = fabric.scene().yarns[y].is_periodic && mine.rows == yarn.points;
        row += mine.rows;
        if (mine.rows > 0) all.push_back(mine);
    }
    return all;
}

template std::vector<YarnRows> rows_of_yarns(const Fabric<float>&);
template std::vector<YarnRows> rows_of_yarns(const Fabric<double>&);

template <class Real>
RowPlaces places_of(const Fabric<Real>& fabric) {
    RowPlaces places;
    const std::vector<Real> state = fabric.state();
    for (std::size_t slot = 0; slot < fabric.slots(); ++slot) {
        if (fabric.moves()[slot] != 0)
            places.at.push_back({static_cast<double>(state[3 * slot]), static_cast<double>(state[3 * slot + 1])});
    }
    for (std::size_t k = 0; k < 2; ++k)
        places.period[k] = fabric.scene().is_periodic[k] ? fabric.scene().period_mm[k] : 0;
    return places;
}

template RowPlaces places_of(const Fabric<float>&);
template RowPlaces places_of(const Fabric<double>&);

Hierarchy::Hierarchy(std::vector<YarnRows> yarns, RowPlaces places, std::size_t last_rows) : m_last_rows(last_rows) {
    std::size_t rows = 0;
    for (const YarnRows& yarn : yarns) rows += yarn.rows;
    m_levels.emplace_back().rows = rows;
    while (m_levels.back().rows > last_rows) {
        // Yarns that are one piece each are bundled with those beside them.
        if (m_levels.back().rows == yarns.size())
            yarns = {{0, static_cast<std::uint32_t>(yarns.size()), false}};
        add_pieces_of_yarns(m_levels.size() - 1, yarns);
    }
    if (places.at.size() != rows || m_levels.size() <= grids_from) return;
    for (std::size_t l = 1; l <= grids_from; ++l) places = places_of_pieces(m_levels[l], places);
    add_grids(grids_from, std::move(places));
}

/// Groups the rows of a level into pieces; `yarns` become those of the pieces.
void Hierarchy::add_pieces_of_yarns(std::size_t finer, std::vector<YarnRows>& yarns) {
    std::vector<PieceShares> all;
    std::uint32_t pieces = 0;
    for (YarnRows& yarn : yarns) {
        const std::uint32_t count = pieces_of(yarn.rows);
        for (std::uint32_t i = 0; i < yarn.rows; ++i) {
            PieceShares shares{{pieces}, {1}};
            if (count > 1) {
                const double at = yarn.is_closed ? double(i) * count / yarn.rows
                                                   : double(i) * (count - 1) / (yarn.rows - 1);
                const auto piece = static_cast<std::uint32_t>(at);
                const std::uint32_t next = piece + 1 < count ? piece + 1 : yarn.is_closed ? 0 : piece;
                shares = {{pieces + piece, pieces + next}, {1 - (at - piece), at - piece}};
            }
            all.push_back(shares);
        }
        yarn = {pieces, count, yarn.is_closed};
        pieces += count;
    }
    add_level(finer, std::move(all), pieces);
}

void Hierarchy::add_level(std::size_t finer, std::vector<PieceShares> shares, std::size_t pieces) {
    m_levels[finer].coarser.push_back(m_levels.size());
    PieceLevel& level = m_levels.emplace_back();
    level.rows = pieces;
    level.shares = std::move(shares);
    level.first_member.assign(pieces + 1, 0);
    const auto each_share = [&](const auto& visit) {
        for (std::uint32_t row = 0; row < level.shares.size(); ++row) {
            for (std::size_t k = 0; k < 4; ++k) {
                if (level.shares[row].weight[k] != 0) visit(row, level.shares[row].of[k], level.shares[row].weight[k]);
            }
        }
    };
    each_share([&](std::uint32_t, std::uint32_t piece, double) { ++level.first_member[piece + 1]; });
    for (std::size_t piece = 0; piece < pieces; ++piece)
        level.first_member[piece + 1] += level.first_member[piece];
    level.members.resize(level.first_member.back());
    level.member_weight.resize(level.members.size());
    std::vector<std::uint32_t> next(level.first_member.begin(), level.first_member.end() - 1);
    each_share([&](std::uint32_t row, std::uint32_t piece, double weight) {
        level.member_weight[next[piece]] = weight;
        level.members[next[piece]++] = row;
    });
}

/// A piece lies where the row lies that belongs to it most.
RowPlaces Hierarchy::places_of_pieces(const PieceLevel& pieces, const RowPlaces& places) {
    RowPlaces of{std::vector<std::array<double, 2>>(pieces.rows), places.period};
    std::vector<double> most(pieces.rows, 0);
    for (std::size_t row = 0; row < pieces.shares.size(); ++row) {
        for (std::size_t k = 0; k < 4; ++k) {
            const std::uint32_t piece = pieces.shares[row].of[k];
            if (pieces.shares[row].weight[k] <= most[piece]) continue;
            most[piece] = pieces.shares[row].weight[k];
            of.at[piece] = places.at[row];
        }
    }
    return of;
}

/// From a node for every few pieces on, each grid twice as wide as the one before.
void Hierarchy::add_grids(std::size_t finer, RowPlaces places) {
    std::array<double, 2> size{1e-9, 1e-9};
    for (std::size_t k = 0; k < 2; ++k) {
        for (const std::array<double, 2>& at : places.at) size[k] = std::max(size[k], at[k] - places.at[0][k]);
    }
    double spacing = std::sqrt(pieces_per_node * size[0] * size[1] / static_cast<double>(places.at.size()));
    while (m_levels[finer].rows > m_last_rows && add_grid(finer, spacing, places)) {
        finer = m_levels.size() - 1;
        spacing *= 2;
    }
}

/// Each row belongs to the four nodes around it; `places` become those of the nodes. False if they are not fewer.
bool Hierarchy::add_grid(std::size_t finer, double spacing, RowPlaces& places) {
    std::array<double, 2> low{1e300, 1e300}, step{};
    std::array<std::int64_t, 2> around{};  // nodes to the period
    for (std::size_t k = 0; k < 2; ++k) {
        for (const std::array<double, 2>& at : places.at) low[k] = std::min(low[k], at[k]);
        around[k] = places.period[k] > 0 ? std::max<std::int64_t>(1, std::llround(places.period[k] / spacing)) : 0;
        step[k] = around[k] > 0 ? places.period[k] / static_cast<double>(around[k]) : spacing;
    }
    std::map<std::array<std::int64_t, 2>, std::uint32_t> numbers;
    std::vector<std::array<double, 2>> nodes;
    std::vector<PieceShares> all;
    for (const std::array<double, 2>& at : places.at) {
        const double x = (at[0] - low[0]) / step[0], y = (at[1] - low[1]) / step[1], i = std::floor(x), j = std::floor(y);
        PieceShares shares;
        for (std::size_t k = 0; k < 4; ++k) {
            const auto right = static_cast<double>(k % 2), up = static_cast<double>(k / 2);
            std::array<std::int64_t, 2> node{std::llround(i + right), std::llround(j + up)};
            for (std::size_t axis = 0; axis < 2; ++axis) {
                if (around[axis] > 0) node[axis] = wrapped(node[axis], around[axis]).index;
            }
            const double weight = (k % 2 == 0 ? 1 - (x - i) : x - i) * (k / 2 == 0 ? 1 - (y - j) : y - j);
            if (weight == 0) {
                shares.weight[k] = 0;
                continue;
            }
            const auto [found, is_new] = numbers.try_emplace(node, static_cast<std::uint32_t>(nodes.size()));
            if (is_new)
                nodes.push_back({low[0] + static_cast<double>(node[0]) * step[0],
                                 low[1] + static_cast<double>(node[1]) * step[1]});
            // On a small torus the same node may lie on two sides.
            std::size_t to = 0;
            while (to < k && !(shares.of[to] == found->second && shares.weight[to] != 0)) ++to;
            if (to == k) shares.weight[k] = 0;
            shares.of[to] = found->second;
            shares.weight[to] += weight;
        }
        all.push_back(shares);
    }
    if (nodes.size() >= places.at.size()) return false;
    places.at = std::move(nodes);
    add_level(finer, std::move(all), places.at.size());
    return true;
}

}  // namespace weave::sim
