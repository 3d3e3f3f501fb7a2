#include <weave/design/design.hpp>

#include <weave/core/text.hpp>

#include <algorithm>
#include <cmath>

namespace weave {

namespace {

template <class... Cases>
struct Overload : Cases... {
    using Cases::operator()...;
};
template <class... Cases>
Overload(Cases...) -> Overload<Cases...>;  // clang 14 does not deduce this by itself

/// What is held by both is not compared with itself, however large.
template <class T>
bool same_content(const std::shared_ptr<const T>& a, const std::shared_ptr<const T>& b) {
    return a == b || *a == *b;
}

bool same(const StacksLeaf& a, const StacksLeaf& b) {
    return same_content(a.block, b.block);
}
bool same(const CardLeaf& a, const CardLeaf& b) {
    return same_content(a.card, b.card) && a.t == b.t && a.p == b.p;
}
bool same(const PresetLeaf& a, const PresetLeaf& b) {
    return a.preset == b.preset;
}
bool same(const SliceLeaf& a, const SliceLeaf& b) {
    return a.slice == b.slice;
}
bool same(const TileOperation& a, const TileOperation& b) {
    return a.of == b.of && a.x == b.x && a.y == b.y && a.z == b.z;
}
bool same(const AttachOperation& a, const AttachOperation& b) {
    return a.of == b.of && a.other == b.other && a.face == b.face;
}
bool same(const StencilOperation& a, const StencilOperation& b) {
    return a.of == b.of && same_content(a.map, b.map);
}
bool same(const RenumberOperation& a, const RenumberOperation& b) {
    return a.of == b.of && a.system == b.system && a.line == b.line && a.order == b.order;
}

enum class Mark : std::uint8_t { fresh, open, done };

/// Depth first, without recursion, since a file decides how deep the tree is.
Status check_tree(const Design& design) {
    std::map<std::string, Mark> marks;
    struct Step {
        std::string name;
        std::vector<std::string> children;
        std::size_t next = 0;
    };
    for (const auto& [start, ignored] : design.blocks) {
        std::vector<Step> path;
        const auto enter = [&](const std::string& name) {
            marks[name] = Mark::open;
            path.push_back({name, children_of(*design.blocks.at(name)), 0});
        };
        if (marks[start] == Mark::fresh) enter(start);
        while (!path.empty()) {
            Step& step = path.back();
            if (step.next == step.children.size()) {
                marks[step.name] = Mark::done;
                path.pop_back();
                continue;
            }
            const std::string child = step.children[step.next++];
            if (!design.blocks.contains(child)) {
                return bad_input("is made from '" + child + "', which is not a block of this design",
                                 "blocks." + step.name);
            }
            if (marks[child] == Mark::open) {
                std::string chain;
                const auto first =
                    std::find_if(path.begin(), path.end(), [&](const Step& s) { return s.name == child; });
                for (auto at = first; at != path.end(); ++at) chain += at->name + " > ";
                return bad_input("the blocks are made from each other in a circle: " + chain + child,
                                 "blocks." + child);
            }
            if (marks[child] == Mark::fresh) enter(child);
        }
    }
    return {};
}

/// False for what is not a number as well.
bool within(double value, double low, double high) {
    return value >= low && value <= high;
}

Status check_text(const std::string& text, std::size_t longest, const std::string& where) {
    if (text.size() > longest)
        return bad_input("is longer than " + std::to_string(longest) + " bytes", where);
    if (!is_utf8(text)) return bad_input("is not UTF-8", where);
    return {};
}

Status check_yarn(const YarnType& yarn, const std::string& where) {
    WEAVE_CHECK_OK(check_text(yarn.name, longest_yarn_name, where + ".name"));
    if (!within(yarn.radius_mm, 1e-4, 100)) return bad_input("needs a radius from 0.0001 to 100 mm", where);
    if (!within(yarn.linear_density_tex, 1e-3, 1e7))
        return bad_input("needs a linear density from 0.001 to 1e7 tex", where);
    if (!within(yarn.stretch_stiffness_N, 1e-9, 1e12))
        return bad_input("needs a stretch stiffness from 1e-9 to 1e12 N", where);
    if (!within(yarn.bending_stiffness_N_mm2, 0, 1e12))
        return bad_input("needs a bending stiffness from 0 to 1e12 N mm2", where);
    if (!within(yarn.contact_stiffness_N_mm2, 1e-9, 1e12))
        return bad_input("needs a contact stiffness from 1e-9 to 1e12 N/mm2", where);
    return {};
}

Status check_yarns(const std::vector<YarnType>& yarns, const std::string& where) {
    if (yarns.empty()) return bad_input("needs at least one yarn", where);
    for (std::size_t k = 0; k < yarns.size(); ++k) {
        WEAVE_CHECK_OK(check_yarn(yarns[k], where + "[" + std::to_string(k) + "]"));
    }
    return {};
}

Status check_sequence(const Sequence& sequence, std::size_t below, const std::string& where) {
    if (sequence.once.empty()) return bad_input("is empty, but needs at least one number", where);
    if (sequence.once.size() > longest_sequence)
        return bad_input("is longer than " + std::to_string(longest_sequence) + " elements", where);
    for (const std::uint32_t number : sequence.once) {
        if (number >= below) {
            return bad_input("names number " + std::to_string(number) + ", but there are only " +
                                 std::to_string(below) + ", counted from 0",
                             where);
        }
    }
    return {};
}

Status check_warp(const WarpPlan& warp) {
    WEAVE_CHECK_OK(check_yarns(warp.yarns, "warp.yarns"));
    if (warp.beams.empty()) return bad_input("needs at least one beam", "warp.beams");
    for (std::size_t k = 0; k < warp.beams.size(); ++k) {
        WEAVE_CHECK_OK(
            check_text(warp.beams[k].name, longest_yarn_name, "warp.beams[" + std::to_string(k) + "].name"));
    }
    WEAVE_CHECK_OK(check_sequence(warp.order, warp.yarns.size(), "warp.order"));
    WEAVE_CHECK_OK(check_sequence(warp.beam_order, warp.beams.size(), "warp.beam_order"));
    WEAVE_CHECK_OK(check_sequence(warp.colour_order, warp.colours.size() + 1, "warp.colour_order"));
    if (!within(warp.density_ends_per_cm, 0.01, 1e4)) {
        return bad_input("must be from 0.01 to 10000", "warp.density_ends_per_cm");
    }
    if (warp.ends_per_dent == 0 || warp.ends_per_dent > 1000)
        return bad_input("must be from 1 to 1000", "warp.ends_per_dent");
    return {};
}

Status check_weft(const WeftPlan& weft) {
    WEAVE_CHECK_OK(check_yarns(weft.yarns, "weft.yarns"));
    if (weft.feeders.empty() || weft.feeders.size() > 64)
        return bad_input("needs 1 to 64 feeders", "weft.feeders");
    for (std::size_t k = 0; k < weft.feeders.size(); ++k) {
        WEAVE_CHECK_OK(check_text(weft.feeders[k].name, longest_yarn_name,
                                  "weft.feeders[" + std::to_string(k) + "].name"));
        if (weft.feeders[k].yarn >= weft.yarns.size()) {
            return bad_input("names yarn " + std::to_string(weft.feeders[k].yarn) + ", but there are only " +
                                 std::to_string(weft.yarns.size()) + ", counted from 0",
                             "weft.feeders[" + std::to_string(k) + "]");
        }
    }
    if (weft.feeder_order.empty())
        return bad_input("is empty, but needs at least one pick", "weft.feeder_order");
    if (weft.feeder_order.size() > longest_sequence)
        return bad_input("is longer than " + std::to_string(longest_sequence) + " picks",
                         "weft.feeder_order");
    for (const FeederSet& set : weft.feeder_order) {
        if (set.size() > 2) return bad_input("gives a pick more than two feeders", "weft.feeder_order");
        if (set.size() == 2 && set[0] == set[1])
            return bad_input("gives a pick the same feeder twice", "weft.feeder_order");
        for (const std::uint32_t feeder : set) {
            if (feeder >= weft.feeders.size()) {
                return bad_input("names feeder " + std::to_string(feeder) + ", but there are only " +
                                     std::to_string(weft.feeders.size()) + ", counted from 0",
                                 "weft.feeder_order");
            }
        }
    }
    if (weft.directions.size() > longest_sequence || weft.take_up.size() > longest_sequence) {
        return bad_input(
            "has directions or take-up for more than " + std::to_string(longest_sequence) + " picks", "weft");
    }
    if (!within(weft.density_picks_per_cm, 0.01, 1e4)) {
        return bad_input("must be from 0.01 to 10000", "weft.density_picks_per_cm");
    }
    return {};
}

Status check_system(const SystemScene& system, const std::string& where) {
    const auto fits = [](const std::optional<double>& value, double low, double high) {
        return !value || within(*value, low, high);
    };
    if (!fits(system.strain, 1, 2)) return bad_input("must be from 1 to 2", where + ".strain");
    if (!fits(system.stiffness_scale, 1e-9, 1e9))
        return bad_input("must be from 1e-9 to 1e9", where + ".stiffness_scale");
    if (!fits(system.radius_scale, 1e-9, 1e9))
        return bad_input("must be from 1e-9 to 1e9", where + ".radius_scale");
    return {};
}

Status check_scene(const Scene& scene) {
    const std::pair<const char*, const std::optional<double>*> spacings[] = {
        {"scene.dx_mm", &scene.dx_mm}, {"scene.dy_mm", &scene.dy_mm}, {"scene.dz_mm", &scene.dz_mm}};
    for (const auto& [where, spacing] : spacings) {
        if (*spacing && !within(**spacing, 1e-6, 1e6)) return bad_input("must be from 1e-6 to 1e6 mm", where);
    }
    WEAVE_CHECK_OK(check_system(scene.warp, "scene.warp"));
    WEAVE_CHECK_OK(check_system(scene.weft, "scene.weft"));
    for (std::size_t k = 0; k < scene.pins.size(); ++k) {
        if (scene.pins[k].number > static_cast<std::size_t>(most_yarn_number))
            return bad_input("names a yarn that no cloth has",
                             "scene.pins[" + std::to_string(k) + "].number");
    }
    for (std::size_t k = 0; k < scene.fields.size(); ++k) {
        const ForceField& field = scene.fields[k];
        const std::string where = "scene.fields[" + std::to_string(k) + "]";
        for (const double x : field.centre_mm) {
            if (!within(x, -1e9, 1e9)) return bad_input("must be from -1e9 to 1e9 mm", where + ".centre_mm");
        }
        if (!within(field.radius_mm, 1e-6, 1e6))
            return bad_input("must be from 1e-6 to 1e6 mm", where + ".radius_mm");
        if (!within(field.strength_N_per_mm, -1e9, 1e9))
            return bad_input("must be from -1e9 to 1e9 N/mm", where + ".strength_N_per_mm");
    }
    if (!within(scene.friction, 0, 100)) return bad_input("must be from 0 to 100", "scene.friction");
    return {};
}

}  // namespace

std::vector<std::string> children_of(const Node& node) {
    using Names = std::vector<std::string>;
    return std::visit(Overload{[](const TileOperation& tile) { return Names{tile.of}; },
                               [](const AttachOperation& attach) {
                                   return Names{attach.of, attach.other};
                               },
                               [](const StencilOperation& stencil) { return stencil.of; },
                               [](const RenumberOperation& renumber) { return Names{renumber.of}; },
                               [](const auto&) { return Names{}; }},
                      node.source);
}

bool operator==(const Node& a, const Node& b) {
    if (a.flips != b.flips || a.source.index() != b.source.index()) return false;
    return std::visit(
        [&](const auto& source) { return same(source, std::get<std::decay_t<decltype(source)>>(b.source)); },
        a.source);
}

bool operator==(const Design& a, const Design& b) {
    const auto same_blocks = [](const auto& one, const auto& other) {
        return one.first == other.first && *one.second == *other.second;
    };
    return a.title == b.title && a.notes == b.notes && a.root == b.root && a.warp == b.warp &&
           a.weft == b.weft && a.scene == b.scene && a.view == b.view &&
           std::equal(a.blocks.begin(), a.blocks.end(), b.blocks.begin(), b.blocks.end(), same_blocks);
}

Status check_block_name(const std::string& name) {
    const auto plain = [](char c) {
        return (c >= '0' && c <= '9') || (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z');
    };
    const bool fine = !name.empty() && name.size() <= 64 && plain(name[0]) &&
                      std::all_of(name.begin(), name.end(),
                                  [&](char c) { return plain(c) || c == '-' || c == '_' || c == '.'; });
    if (fine) return {};
    return bad_input(
        "'" + name.substr(0, 80) +
        "' is not a block name: 1 to 64 letters, digits, '-', '_' or '.', starting with a letter or digit");
}

Status check_texts(const std::string& title, const std::string& notes) {
    WEAVE_CHECK_OK(check_text(title, longest_title, "title"));
    return check_text(notes, longest_notes, "notes");
}

Status check(const Design& design) {
    WEAVE_CHECK_OK(check_texts(design.title, design.notes));
    if (design.blocks.size() > most_blocks)
        return bad_input("has more than " + std::to_string(most_blocks) + " blocks", "blocks");
    for (const auto& [name, node] : design.blocks) {
        if (Status fine = check_block_name(name); !fine) return std::move(fine).error().under("blocks");
        if (!node) return bad_input("is missing", "blocks." + name);
        if (Status fine = check(*node); !fine) return std::move(fine).error().under("blocks." + name);
    }
    if (!design.blocks.contains(design.root)) {
        return bad_input("'" + design.root.substr(0, 80) + "' is not a block of this design", "root");
    }
    WEAVE_CHECK_OK(check_tree(design));
    WEAVE_CHECK_OK(check_warp(design.warp));
    WEAVE_CHECK_OK(check_weft(design.weft));
    WEAVE_CHECK_OK(check_scene(design.scene));
    return design.view.is_object() ? Status() : bad_input("must be an object", "view");
}

}  // namespace weave
