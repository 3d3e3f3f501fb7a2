#pragma once

#include <weave/design/design.hpp>

#include <catch2/catch.hpp>

#include <memory>
#include <string>
#include <vector>

namespace weave::testing {

inline NodePtr node(NodeSource source, std::vector<Flip> flips = {}) {
    return std::make_shared<const Node>(Node{std::move(source), std::move(flips)});
}

/// A leaf from stacks with numbers that count within each cell.
inline NodePtr leaf(const std::vector<std::vector<std::string>>& rows) {
    std::vector<std::uint32_t> t, p;
    for (const auto& row : rows) t.push_back(static_cast<std::uint32_t>(parse_stack(row[0]).value().wefts()));
    for (const auto& stack : rows[0])
        p.push_back(static_cast<std::uint32_t>(parse_stack(stack).value().warps()));
    const Result<Block> block =
        make_block(t, p, [&](std::size_t i, std::size_t j) { return parse_stack(rows[i][j]).value(); });
    REQUIRE(block);
    return node(StacksLeaf{std::make_shared<const Block>(*block)});
}

/// Plain weave, two by two.
inline NodePtr plain() {
    return leaf({{"P0 T0", "T0 P0"}, {"T0 P0", "P0 T0"}});
}

inline NodePtr stencil_of(std::vector<std::string> of, std::size_t rows, std::size_t columns,
                          std::vector<std::uint16_t> numbers) {
    return node(StencilOperation{
        std::move(of), std::make_shared<const StencilMap>(StencilMap{rows, columns, std::move(numbers)})});
}

inline Design design_of(std::map<std::string, NodePtr> blocks, std::string root) {
    Design design;
    design.blocks = std::move(blocks);
    design.root = std::move(root);
    return design;
}

}  // namespace weave::testing
