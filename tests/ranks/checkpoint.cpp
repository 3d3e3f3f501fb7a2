// A run goes on from its checkpoints with any number of ranks, to the same bits; a checkpoint that is not whole does not count.

#include "split_cases.hpp"
#include "thread_ranks.hpp"

#include <weave/core/file.hpp>
#include <weave/ranks/split_run.hpp>
#include <weave/sim/result.hpp>
#include <weave/sim/yarns_file.hpp>

#include <filesystem>
#include <support/temporary_folder.hpp>
#include <sys/mount.h>
#include <sys/stat.h>
#include <unistd.h>

namespace weave::ranks::testing {

namespace {

namespace fs = std::filesystem;

using Folder = weave::testing::TemporaryFolder;

struct Ended {
    Json report;
    std::string trouble;
    std::vector<std::string> notes;
};

/// Runs by so many ranks; `stop_after`: a rank's caller ends it then.
Ended run(const Folder& folder, std::size_t ranks, std::size_t stop_after = SIZE_MAX, const std::string& sample = "angle-interlock-b") {
    Ended ended;
    by_ranks(ranks, [&](Comm& comm) {
        SplitOptions options;
        options.residual = 1e-6;
        options.points_a_block = 60;
        options.checkpoints = folder.path / "ck";
        options.checkpoint_every_s = 0;
        options.watch = [&](const sim::Progress& progress) { return comm.rank() != comm.size() - 1 || progress.iteration < stop_after; };
        if (comm.is_first()) options.note = [&](const std::string& line) { ended.notes.push_back(line); };
        Stretched stretched({sample, 60});
        const auto report = simulate_split(comm, stretched.design, std::move(stretched.plan), options, folder.path / "cloth.yarns");
        if (comm.is_first()) {
            if (report) ended.report = *report;
            if (!report) ended.trouble = report.error().text();
        }
    });
    return ended;
}

Yarns yarns_of(const Folder& folder) {
    return read_yarns(read_file(folder.path / "cloth.yarns").value()).value();
}

std::vector<Vec3> places(const Yarns& yarns) {
    std::vector<Vec3> all;
    for (const SimulatedYarn& yarn : yarns.yarns) all.insert(all.end(), yarn.spline.control.begin(), yarn.spline.control.end());
    return all;
}

fs::path only_step(const Folder& folder) {
    std::vector<fs::path> steps(fs::directory_iterator(folder.path / "ck"), {});
    REQUIRE(steps.size() == 1);
    return steps.front();
}

}  // namespace

TEST_CASE("a run that goes on from a checkpoint, with another number of ranks, comes to the bits of one left alone") {
    Folder alone, cut;
    const Ended whole = run(alone, 2);
    REQUIRE(whole.trouble.empty());
    REQUIRE(whole.report.at("converged") == true);
    REQUIRE(whole.report.at("iterations") > 200);
    const Ended first = run(cut, 3, 200);  // at the end of a leg
    REQUIRE(first.report.at("ending") == "stopped");
    REQUIRE(only_step(cut).filename() == "step-200");
    const Ended second = run(cut, 5);
    CHECK_THAT(second.notes.at(0), Catch::Contains("going on from the checkpoint of step 200"));
    CHECK(second.report.at("converged") == true);
    CHECK(second.report.at("iterations") == whole.report.at("iterations"));
    CHECK(second.report.at("energy_N_mm") == whole.report.at("energy_N_mm"));
    const Yarns one = yarns_of(alone), other = yarns_of(cut);
    CHECK(places(one) == places(other));
    CHECK(one.yarns[3].strain == other.yarns[3].strain);
    CHECK(one.yarns[3].contact_N == other.yarns[3].contact_N);
    CHECK(one.crossings.size() == other.crossings.size());
    CHECK(one.report.at("order_kept") == true);
}

TEST_CASE("what is written of a cut cloth is what one process writes of it") {
    const std::string sample = GENERATE("angle-interlock-b", "hexagon-tubes", "tl013-corrected");  // the latter two as repeats of a larger cloth
    INFO(sample);
    Folder folder;
    const bool comes_to_rest = sample == "angle-interlock-b";  // soon enough to wait for
    const Ended ended = run(folder, 3, comes_to_rest ? SIZE_MAX : 30, sample);
    REQUIRE(ended.trouble.empty());
    REQUIRE(ended.report.at("converged") == comes_to_rest);
    const Design design = find_sample(sample)->make();
    sim::Plan plan = plan_of({sample, 0});
    const Yarns cut = yarns_of(folder);
    const std::size_t copies = plan.repeats[0] * plan.repeats[1];
    CHECK((copies > 1) == (sample != "angle-interlock-b"));
    const sim::Executor executor(1);
    const sim::Fabric<double> fabric(plan.scene);
    sim::Energy<double> energy(fabric, executor);
    std::vector<double> state = fabric.state(), unused;
    energy.first_weights(state);
    const auto is_weft = [&](std::size_t y) { return plan.curves.yarns[plan.curve_of[y]].system == System::weft; };
    std::size_t wefts = 0;
    while (wefts < plan.curve_of.size() && is_weft(wefts)) ++wefts;
    for (std::size_t y = 0; y < plan.scene.yarns.size(); ++y) {
        const SimulatedYarn& first_copy = cut.yarns.at(is_weft(y) ? y : plan.repeats[0] * wefts + y - wefts);
        for (std::size_t i = 0; i < plan.scene.yarns[y].control.size(); ++i) {
            for (std::size_t k = 0; k < 3; ++k) state[3 * (fabric.yarns()[y].first_slot + 1 + i) + k] = first_copy.spline.control[i][Eigen::Index(k)];
        }
    }
    fabric.follow(state);
    energy.evaluate(state, unused);
    const Yarns whole = sim::copied_back(sim::yarns_in_state(design, plan, energy, state), plan, design);
    CHECK((cut.region == whole.region && cut.size_mm == whole.size_mm));
    REQUIRE(whole.yarns.size() == cut.yarns.size());
    for (std::size_t y = 0; y < cut.yarns.size(); ++y) {
        INFO("yarn " << y);
        const SimulatedYarn &a = whole.yarns[y], &b = cut.yarns[y];
        CHECK((a.system == b.system && a.number == b.number && a.beam == b.beam && a.colour == b.colour && a.spline.shift == b.spline.shift));
        REQUIRE(a.planned.size() == b.planned.size());
        for (std::size_t i = 0; i < a.planned.size(); ++i) REQUIRE((a.planned[i] - b.planned[i]).norm() < 1e-12);
        for (std::size_t i = 0; i < a.planned.size(); ++i) REQUIRE((a.spline.control[i] - b.spline.control[i]).norm() < 1e-12);
        CHECK(b.length_mm == Approx(a.length_mm).epsilon(1e-13));
        CHECK(b.rest_length_mm == Approx(a.rest_length_mm).epsilon(1e-13));
        CHECK(b.planned_length_mm == Approx(a.planned_length_mm).epsilon(1e-13));
        for (std::size_t i = 0; i < a.strain.size(); ++i) {
            REQUIRE(b.strain[i] == Approx(a.strain[i]).margin(1e-12));
            REQUIRE(b.contact_N[i] == Approx(a.contact_N[i]).margin(1e-9));
        }
    }
    REQUIRE(whole.crossings.size() == cut.crossings.size());
    for (std::size_t k = 0; k < whole.crossings.size(); ++k) {
        const Crossing &a = whole.crossings[k], &b = cut.crossings[k];
        REQUIRE((a.weft == b.weft && a.weft_key == b.weft_key && a.warp == b.warp && a.warp_key == b.warp_key && a.pick == b.pick && a.end == b.end && a.weft_over == b.weft_over));
    }
    const sim::Contacts contacts = sim::contacts_of(energy, state);
    CHECK(cut.report.at("max_overlap").get<double>() == Approx(contacts.overlap).epsilon(1e-12));
    CHECK(cut.report.at("points") == fabric.points());
    CHECK(cut.report.at("crossings") == plan.curves.crossings.size());
}

TEST_CASE("nothing of a folder is touched but checkpoints, and one that is complete stays as it is") {
    Folder folder;
    fs::create_directories(folder.path / "ck" / "step-drawings");
    fs::create_directories(folder.path / "ck" / "step-7");
    for (const char* name : {"step-by-step.md", "step-drawings/a.txt", "step-7/notes.txt", "step-7/rank-0.part.old"}) REQUIRE(write_file(folder.path / "ck" / name, "mine"));
    REQUIRE(run(folder, 2, 40).trouble.empty());
    const auto newest = [&](const char* name) { return read_file(folder.path / "ck" / "step-40" / name).value(); };
    const std::string part = newest("rank-1.part"), complete = newest("complete.json");
    const Ended again = run(folder, 4, 40);  // ends where it begins
    CHECK(again.trouble.empty());
    CHECK(newest("rank-1.part") == part);
    CHECK(newest("complete.json") == complete);
    CHECK_FALSE(fs::exists(folder.path / "ck" / "step-40" / "rank-3.part"));
    REQUIRE(run(folder, 1, 60).trouble.empty());
    CHECK_FALSE(fs::exists(folder.path / "ck" / "step-40"));
    for (const char* name : {"step-by-step.md", "step-drawings/a.txt", "step-7/notes.txt", "step-7/rank-0.part.old"}) CHECK(read_file(folder.path / "ck" / name).value() == "mine");
}

TEST_CASE("a checkpoint of another part, or with another crossing held, is of another run") {
    Folder folder;
    const auto trouble = [&](const Region& region, std::vector<std::array<std::size_t, 2>> held) {
        std::string text;
        by_ranks(2, [&](Comm& comm) {
            const Design design = find_sample("twill-g")->make();
            const BlockPtr block = evaluate(design)->block;
            sim::SimulationRequest request = request_of({"twill-g", 0, true, {}, region});
            request.held = held;
            SplitOptions options;
            options.points_a_block = 60;
            options.most_iterations = 5;
            options.checkpoints = folder.path / "ck";
            const auto report = simulate_split(comm, design, sim::PlanInStretches::make(design, *block, request).value(), options, folder.path / "cloth.yarns");
            if (comm.is_first() && !report) text = report.error().text();
        });
        return text;
    };
    REQUIRE(trouble({0, 3, 0, 3}, {}).empty());
    CHECK_THAT(trouble({1, 4, 0, 3}, {}), Catch::Contains("another design, scene or plan"));
    CHECK_THAT(trouble({0, 3, 0, 3}, {{2, 2}}), Catch::Contains("another design, scene or plan"));
    CHECK(trouble({0, 3, 0, 3}, {}).empty());
}

TEST_CASE("ranks that were given other designs, or see other folders, are told so by all alike") {
    Folder folder, other;
    std::vector<std::string> told(3), shared(3);
    by_ranks(3, [&](Comm& comm) {
        Stretched stretched({comm.rank() == 2 ? "satin-5" : "twill-2-2", 60});
        const auto report = simulate_split(comm, stretched.design, std::move(stretched.plan), {}, folder.path / "cloth.yarns");
        told[comm.rank()] = report ? "" : report.error().text();
        const Status status = Checkpoints(comm.rank() == 1 ? other.path : folder.path, {}).try_out(comm);
        shared[comm.rank()] = status ? "" : status.error().text();
    });
    CHECK_THAT(told[0], Catch::Contains("rank 2") && Catch::Contains("another design"));
    CHECK((told[1] == told[0] && told[2] == told[0]));
    CHECK_THAT(shared[0], Catch::Contains("rank 1") && Catch::Contains("all processes share"));
    CHECK((shared[1] == shared[0] && shared[2] == shared[0]));
    CHECK(fs::is_empty(folder.path));
    CHECK_FALSE(fs::exists(folder.path / "cloth.yarns"));
}

TEST_CASE("what one rank cannot write, as on a full disk of its machine, all know with its cause") {
    Folder folder, small;
    const bool is_mounted = ::mount("none", small.path.c_str(), "tmpfs", 0, "size=8k") == 0;
    if (!is_mounted) REQUIRE(write_file(small.path / "step-0", "a file where the step's folder should be"));  // not root: another cause
    std::vector<std::string> told(3);
    by_ranks(3, [&](Comm& comm) {
        const Case of{"pocket", 700};
        const CutPlan cut = cut_of(of, comm);
        Stand stand;
        stand.state = planned(cut.parts);
        const fs::path place = comm.rank() == 1 ? small.path : folder.path;
        if (comm.rank() == 1 && is_mounted) fs::create_directories(place / "step-0");
        const Status status = Checkpoints(place, {}).write(comm, cut.cut, cut.parts, stand);
        told[comm.rank()] = status ? "" : status.error().text();
    });
    if (is_mounted) ::umount(small.path.c_str());
    CHECK_THAT(told[0], Catch::Contains("rank 1") && Catch::Contains((small.path / "step-0").string()) && Catch::Contains(is_mounted ? "No space left" : ""));
    CHECK((told[1] == told[0] && told[2] == told[0]));
    CHECK_FALSE(fs::exists(folder.path / "step-0" / "complete.json"));
}

TEST_CASE("a checkpoint that is damaged, cut short, or of another run is refused with its place") {
    Folder folder;
    REQUIRE(run(folder, 2, 40).trouble.empty());
    const fs::path part = only_step(folder) / "rank-1.part", complete = only_step(folder) / "complete.json";
    const std::string good = read_file(part).value();
    const auto refused = [&](const std::string& bytes) {
        REQUIRE(write_file(part, bytes));
        const Ended ended = run(folder, 2);
        CHECK(ended.report.is_null());
        return ended.trouble;
    };
    std::string turned = good;
    turned[good.size() - 5] = static_cast<char>(turned[good.size() - 5] ^ 1);
    CHECK_THAT(refused(turned), Catch::Contains("rank 1"));
    CHECK_THAT(refused(good.substr(0, good.size() - 8)), Catch::Contains("rank 1"));
    CHECK_THAT(refused("{}"), Catch::Contains("rank 1"));
    CHECK_THAT(refused(R"({"first_block":0,"points":[18446744073709551615],"sha256":""})" "\n"), Catch::Contains("rank 1"));
    REQUIRE(write_file(part, good));
    CHECK_THAT(run(folder, 2, 60, "satin-5").trouble, Catch::Contains("another design") && Catch::Contains("ck"));
    const std::string whole = read_file(complete).value();
    REQUIRE(write_file(complete, "nonsense"));
    CHECK_THAT(run(folder, 1, 60).trouble, Catch::Contains("complete.json"));
    fs::remove(complete);  // as where a run was killed while it wrote
    const Ended anew = run(folder, 1, 60);
    CHECK(anew.trouble.empty());
    CHECK_THAT(anew.notes.at(0), !Catch::Contains("going on"));
}

TEST_CASE("a checkpoint that cannot be written is told, and the run goes on") {
    Folder folder;
    REQUIRE(write_file(folder.path / "ck", "a file where the folder should be"));
    CHECK_THAT(run(folder, 2, 60).trouble, Catch::Contains("ck"));
    fs::remove(folder.path / "ck");
    fs::create_directory(folder.path / "ck");
    REQUIRE(write_file(folder.path / "ck" / "step-60", "a file where the step's folder should be"));
    const Ended ended = run(folder, 2, 60);
    CHECK(ended.trouble.empty());
    REQUIRE_FALSE(ended.notes.empty());
    CHECK_THAT(ended.notes.back(), Catch::Contains("no checkpoint of step 60") && Catch::Contains("there is none before it"));
    CHECK(fs::exists(folder.path / "cloth.yarns"));
}

}  // namespace weave::ranks::testing
