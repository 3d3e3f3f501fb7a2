#pragma once

#include <weave/design/design.hpp>

#include <design/text_node.hpp>
#include <memory>
#include <string>
#include <support/random.hpp>
#include <vector>

namespace weave::testing {

/// A number from `low` to `high` with many digits, so that a writer that drops some is caught.
inline double random_number(Random& random, double low, double high) {
    constexpr std::size_t steps = std::size_t{1} << 50;
    const double share = static_cast<double>(random.between(0, steps)) / static_cast<double>(steps);
    return std::min(high, low + share * (high - low));
}

inline std::string random_text(Random& random, std::size_t most = 12) {
    static const std::vector<std::string> pieces{
        "a", "Z", " ", "\"", "\\", "\n", "\t", "é", "布", "/", "\x01", "\xe2\x80\xa8", "\xf0\x9f\xa7\xb5",
        "7"};
    std::string text;
    for (std::size_t k = random.between(0, most); k > 0; --k)
        text += pieces[random.between(0, pieces.size() - 1)];
    return text;
}

inline std::vector<std::uint32_t> random_counts(Random& random, std::size_t most = 3) {
    std::vector<std::uint32_t> counts(random.between(1, 4));
    for (auto& count : counts) count = static_cast<std::uint32_t>(random.between(1, most));
    return counts;
}

inline CardLeaf random_card_leaf(Random& random) {
    CardImage card(random.between(1, 20), random.between(1, 20));
    for (std::size_t pick = 0; pick < card.picks(); ++pick) {
        for (std::size_t end = 0; end < card.ends(); ++end) card.set(pick, end, random.coin());
    }
    return {std::make_shared<const CardImage>(std::move(card)), random_counts(random), random_counts(random)};
}

inline SliceLeaf random_slice_leaf(Random& random) {
    Slice slice{random.coin() ? System::weft : System::warp, {}};
    const std::size_t paths = random.between(1, 3);
    slice.positions.resize(random.between(1, 4));
    for (auto& position : slice.positions) {
        for (std::size_t k = random.between(0, 3); k-- > 0;) {
            const Slot dot = slice.dots == System::weft ? Slot::weft(k, random.coin()) : Slot::warp(k);
            position.push_back({dot, dot.is_weft() && random.coin()});
        }
        for (std::size_t k = 0; k < paths; ++k) {
            const Slot path = slice.dots == System::weft ? Slot::warp(k) : Slot::weft(k);
            position.push_back({path, path.is_weft() && random.between(0, 5) == 0});
        }
        position.resize(position.size() + random.between(0, 2));
        random.shuffle(position);
    }
    return {std::move(slice)};
}

inline PresetLeaf random_preset_leaf(Random& random) {
    PresetLeaf leaf{{"twill", {}}};
    for (const char* name : {"up", "down", "ends"}) {
        if (random.coin()) leaf.preset.options[name] = static_cast<std::int64_t>(random.between(1, 9)) - 3;
    }
    return leaf;
}

inline StencilOperation random_stencil(Random& random, std::vector<std::string> of) {
    StencilMap map{random.between(1, 5), random.between(1, 5), {}};
    map.blocks.resize(map.rows * map.columns);
    for (auto& number : map.blocks) number = static_cast<std::uint16_t>(random.between(0, of.size() - 1));
    return {std::move(of), std::make_shared<const StencilMap>(std::move(map))};
}

/// Any kind of node; operations are made from `blocks`, so leaves alone come where there are none. It need
/// not make sense as cloth: an order may not fit, an attachment not match.
inline NodePtr random_node(Random& random, const std::vector<std::string>& blocks) {
    const auto one = [&] { return blocks[random.between(0, blocks.size() - 1)]; };
    Node node;
    switch (random.between(0, blocks.empty() ? 3 : 7)) {
        case 0:
            node.source = StacksLeaf{std::make_shared<const Block>(random_block(random))};
            break;
        case 1:
            node.source = random_card_leaf(random);
            break;
        case 2:
            node.source = random_preset_leaf(random);
            break;
        case 3:
            node.source = random_slice_leaf(random);
            break;
        case 4:
            node.source =
                TileOperation{one(), random.between(1, 3), random.between(1, 3), random.between(1, 3)};
            break;
        case 5:
            node.source = AttachOperation{one(), one(), static_cast<Face>(random.between(0, 5))};
            break;
        case 6: {
            std::vector<std::string> of(random.between(1, 3));
            for (auto& name : of) name = one();
            node.source = random_stencil(random, std::move(of));
            break;
        }
        default: {
            std::vector<std::size_t> order(random.between(1, 4));
            for (std::size_t k = 0; k < order.size(); ++k) order[k] = k;
            random.shuffle(order);
            node.source = RenumberOperation{one(), random.coin() ? System::weft : System::warp,
                                            random.between(0, 2), order};
        }
    }
    for (std::size_t k = random.between(0, 2); k > 0; --k)
        node.flips.push_back({random.between(0, 9), random.between(0, 9), random.coin()});
    return std::make_shared<const Node>(std::move(node));
}

inline Sequence random_sequence(Random& random, std::size_t below) {
    Sequence sequence{{}};
    for (std::size_t k = random.between(1, 6); k > 0; --k) {
        sequence.once.insert(sequence.once.end(), random.between(1, 3),
                             static_cast<std::uint32_t>(random.between(0, below - 1)));
    }
    return sequence;
}

inline std::vector<YarnType> random_yarns(Random& random) {
    std::vector<YarnType> yarns(random.between(1, 3));
    for (YarnType& yarn : yarns) {
        const auto byte = [&] { return static_cast<std::uint8_t>(random.between(0, 255)); };
        yarn = {random_text(random),
                {byte(), byte(), byte()},
                random_number(random, 1e-4, 100),
                random_number(random, 1e-3, 1e7),
                random_number(random, 1e-9, 1e12),
                random_number(random, 0, 1),
                random_number(random, 1e-9, 1e-3)};
    }
    return yarns;
}

inline WarpPlan random_warp(Random& random) {
    WarpPlan warp;
    warp.yarns = random_yarns(random);
    warp.order = random_sequence(random, warp.yarns.size());
    for (std::size_t k = random.between(1, 3); k > 0; --k) warp.beams.push_back({random_text(random)});
    warp.beam_order = random_sequence(random, warp.beams.size());
    for (std::size_t k = random.between(0, 2); k > 0; --k)
        warp.colours.push_back({static_cast<std::uint8_t>(random.between(0, 255)), 0, 1});
    warp.colour_order = random_sequence(random, warp.colours.size() + 1);
    warp.density_ends_per_cm = random_number(random, 0.01, 1e4);
    warp.ends_per_dent = static_cast<std::uint32_t>(random.between(1, 1000));
    return warp;
}

inline WeftPlan random_weft(Random& random) {
    WeftPlan weft;
    weft.yarns = random_yarns(random);
    for (std::size_t k = random.between(1, 4); k > 0; --k)
        weft.feeders.push_back(
            {random_text(random), static_cast<std::uint32_t>(random.between(0, weft.yarns.size() - 1))});
    weft.feeder_order.assign(random.between(1, 6), {});
    for (FeederSet& set : weft.feeder_order) {
        const auto last = weft.feeders.size() - 1;
        const std::size_t first = random.between(0, last);
        if (random.between(0, 3) > 0) set.push_back(static_cast<std::uint32_t>(first));
        if (set.size() == 1 && last > 0 && random.coin())
            set.push_back(static_cast<std::uint32_t>((first + 1) % (last + 1)));
    }
    for (std::size_t k = random.between(0, 4); k > 0; --k)
        weft.directions.push_back(static_cast<Direction>(random.between(0, 1)));
    for (std::size_t k = random.between(0, 4); k > 0; --k) weft.take_up.push_back(random.coin());
    weft.density_picks_per_cm = random_number(random, 0.01, 1e4);
    return weft;
}

inline Scene random_scene(Random& random) {
    Scene scene;
    const auto maybe = [&](std::optional<double>& value, double low, double high) {
        if (random.coin()) value = random_number(random, low, high);
    };
    maybe(scene.dx_mm, 1e-6, 1e6), maybe(scene.dy_mm, 1e-6, 1), maybe(scene.dz_mm, 1e-6, 1e-3);
    scene.boundary_x = static_cast<Boundary>(random.between(0, 2));
    scene.boundary_y = static_cast<Boundary>(random.between(0, 2));
    scene.weft_mode = static_cast<WeftMode>(random.between(0, 1));
    scene.insertion = static_cast<Insertion>(random.between(0, 2));
    for (SystemScene* system : {&scene.warp, &scene.weft})
        maybe(system->strain, 1, 2), maybe(system->stiffness_scale, 1e-9, 1e9),
            maybe(system->radius_scale, 0.1, 10);
    for (std::size_t k = random.between(0, 2); k > 0; --k)
        scene.pins.push_back({random.coin(), random.between(0, 99)});
    for (std::size_t k = random.between(0, 2); k > 0; --k) {
        scene.fields.push_back({{random_number(random, -9, 9), 0, random_number(random, -1e9, 1e9)},
                                random_number(random, 1e-6, 1e6),
                                random_number(random, -1e9, 1e9)});
    }
    scene.friction = random_number(random, 0, 100);
    scene.gravity = random.coin();
    return scene;
}

/// A design of every part of the format, which passes check() but need not evaluate.
inline Design random_design(Random& random, std::size_t most_nodes = 6) {
    std::vector<std::string> names{"toe", "heel-2", "4.ply", "Sole_a", "x", "cloth", "tongue", "b.b-b_b"};
    random.shuffle(names);
    names.resize(random.between(1, std::min(most_nodes, names.size())));
    Design design;
    std::vector<std::string> made;
    for (const std::string& name : names) {
        design.blocks[name] = random_node(random, made);
        made.push_back(name);
    }
    design.root = made[random.between(0, made.size() - 1)];
    design.title = random_text(random);
    design.notes = random_text(random, 40);
    design.warp = random_warp(random);
    design.weft = random_weft(random);
    design.scene = random_scene(random);
    if (random.coin())
        design.view = {{"zoom", random_number(random, 0, 1)}, {"open", {"a", 1, true, nullptr}}};
    return design;
}

}  // namespace weave::testing
