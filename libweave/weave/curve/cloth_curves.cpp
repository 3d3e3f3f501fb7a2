#include <weave/curve/cloth_curves.hpp>

#include <weave/curve/cloth_layout.hpp>

#include <utility>

namespace weave {

Result<ClothCurves> cloth_curves(const Design& design, const Block& block, const CurveOptions& options) {
    WEAVE_TRY(const ClothLayout layout, ClothLayout::make(design, block, options));
    return all_curves(layout);
}

ClothCurves all_curves(const ClothLayout& layout) {
    ClothCurves curves = layout.bare();
    for (std::size_t yarn = 0; yarn < curves.yarns.size(); ++yarn) {
        curves.yarns[yarn].keys.reserve(layout.keys(yarn));
        layout.add_keys(yarn, 0, layout.keys(yarn), curves.yarns[yarn].keys);
        if (curves.yarns[yarn].system == System::weft) layout.each_crossing(yarn, [&](const Crossing& crossing) { curves.crossings.push_back(crossing); });
    }
    return curves;
}

}  // namespace weave
