// Reads a design, tells its card image, and relaxes it.
#include <weave/design/document.hpp>
#include <weave/design/evaluate.hpp>
#include <weave/sim/simulate.hpp>

#include <cstdio>

int main(int count, char** arguments) {
    if (count != 2) return std::puts("usage: outside DESIGN.weave"), 2;
    const auto design = weave::load_design(arguments[1]);
    if (!design) return std::puts(design.error().text().c_str()), 3;
    const auto cloth = weave::evaluate(*design);
    if (!cloth) return std::puts(cloth.error().text().c_str()), 3;
    const auto plan = weave::sim::make_plan(*design, *cloth->block, {});
    if (!plan) return std::puts(plan.error().text().c_str()), 3;
    const auto yarns = weave::sim::simulate(*design, *plan, {});
    std::printf("%s %s\n", cloth->block->card_image().sha256().c_str(), yarns.report.at("converged").dump().c_str());
}
