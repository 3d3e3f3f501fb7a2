// Starts that are relaxed at once where there is a device.

#include <weave/design/evaluate.hpp>
#include <weave/samples/samples.hpp>
#include <weave/sim/starts.hpp>

#include <catch2/catch.hpp>

using namespace weave;
using namespace weave::sim;

TEST_CASE("starts: relaxed at once on a device they tell what they tell on the processor", "[device][slow]") {
    const Design design = find_sample("satin-5")->make();
    SimulationRequest request;
    request.fidelity = Fidelity::draft;
    const Plan plan = make_plan(design, *evaluate(design)->block, request).value();
    SimulationOptions here, there;
    here.residual = there.residual = 1e-5;
    here.backend = Backend::cpu;
    there.backend = Backend::cuda;
    const Yarns yarns = simulate(design, plan, here);
    const Json right = relaxed_again(design, plan, here, yarns, 5), found = relaxed_again(design, plan, there, yarns, 5);
    INFO(found.dump());
    CHECK(found.at("at_once") == true);
    CHECK(right.at("at_once") == false);
    for (const char* same : {"runs", "asked", "elsewhere", "not_at_rest", "order_lost"}) CHECK(found.at(same) == right.at(same));
    for (std::size_t k = 0; k < 6; ++k)
        CHECK(found.at("each")[k].at("energy_N_mm").get<double>() == Approx(right.at("each")[k].at("energy_N_mm").get<double>()).epsilon(1e-4));
}
