#include <weave/ranks/split_run.hpp>

#include <weave/core/file.hpp>
#include <weave/core/sha256.hpp>
#include <weave/design/document.hpp>
#include <weave/ranks/split_cloth.hpp>
#include <weave/ranks/split_yarns.hpp>
#include <weave/sim/relaxing.hpp>
#include <weave/sim/result.hpp>

#include <algorithm>
#include <chrono>
#include <utility>

namespace weave::ranks {

namespace {

/// Steps between which the solver forgets: so that whoever goes on from a checkpoint comes to the same bits.
constexpr std::size_t leg_steps = 200;

/// A relaxation by all ranks, leg by leg.
class SplitRun {
  public:
    SplitRun(Comm& comm, const Cut& cut, const std::vector<Part>& parts, const SplitOptions& options, double goal, Stand stand)
        : m_comm(comm), m_cut(cut), m_parts(parts), m_options(options), m_goal(goal), m_stand(std::move(stand)), m_executor(options.threads),
          m_cloth(comm, cut, parts, m_executor, m_stand.state) {}

    /// Legs to the end. `checkpoints`: null where none are written. `newest`: the step of the one that is there.
    void relax(const Checkpoints* checkpoints, std::optional<std::size_t> newest) {
        m_newest = newest;
        m_saved = seconds();
        do {
            leg();
            if (checkpoints != nullptr) save(*checkpoints);
        } while (!m_end);
    }

    [[nodiscard]] SplitCloth& cloth() { return m_cloth; }
    [[nodiscard]] sim::Ending ending() const { return m_end.value_or(sim::Ending::stopped); }
    [[nodiscard]] const sim::Relaxing<SplitCloth>& relaxed() const { return m_relaxing; }
    [[nodiscard]] std::size_t iterations() const { return m_stand.iterations; }
    [[nodiscard]] std::size_t evaluations() const { return m_stand.evaluations + m_cloth.evaluations(); }
    [[nodiscard]] double seconds() const {
        return m_stand.seconds + std::chrono::duration<double>(std::chrono::steady_clock::now() - m_start).count();
    }

    /// Sign of the least second derivative at rest, as a report tells it.
    std::string smallest_curvature() {
        if (ending() != sim::Ending::converged) return "not looked";
        if (m_relaxing.is_looked_at && !m_relaxing.curves_down) return "positive";
        m_cloth.evaluate();
        const sim::Bend bend = sim::Newton<SplitCloth>().bend(m_cloth, m_goal * m_relaxing.reference_N);
        return bend == sim::Bend::up ? "positive" : bend == sim::Bend::down ? "negative" : "unclear";
    }

  private:
    void leg() {
        m_relaxing = {};
        m_relaxing.goal = m_goal;
        m_cloth.begin_anew();
        m_relaxing.begin(m_cloth, m_cloth.greatest_strain());
        for (std::size_t step = 0; step < leg_steps && !m_end; ++step) {
            m_relaxing.judge(m_cloth);
            m_end = ends();
            if (m_end) break;
            if (m_relaxing.is_at_goal() && m_relaxing.leave_saddle(m_cloth) != sim::Step::done)
                m_end = sim::Ending::converged;
            else if (m_stand.iterations >= m_options.most_iterations)
                m_end = sim::Ending::iterations;
            else if (m_relaxing.step(m_cloth) != sim::Step::done)
                m_end = sim::Ending::stuck;
            else
                ++m_stand.iterations;
        }
        if (m_end) m_relaxing.finish(m_cloth);
    }

    /// Whether a rank's caller wants to end, or by the first rank's clock the time is up: the same on all.
    std::optional<sim::Ending> ends() {
        const sim::Progress progress{m_stand.iterations, m_relaxing.residual, m_relaxing.energy, seconds()};
        double wish = m_options.watch && !m_options.watch(progress) ? 1 : 0;
        if (wish == 0 && m_comm.is_first() && seconds() - m_stand.seconds > m_options.most_seconds) wish = 2;
        const std::vector<double> wishes = m_comm.gather(wish);
        const auto first = std::ranges::find_if(wishes, [](double one) { return one != 0; });
        if (first == wishes.end()) return {};
        return *first == 1 ? sim::Ending::stopped : sim::Ending::time;
    }

    /// A checkpoint between two legs, where the first rank's clock says that one is due, or that it is the last.
    void save(const Checkpoints& checkpoints) {
        const bool is_due = m_end || seconds() - m_saved >= m_options.checkpoint_every_s;
        if (m_comm.gather(is_due ? 1.0 : 0.0).front() == 0) return;
        m_saved = seconds();
        Stand now = m_stand;
        now.evaluations = evaluations();
        now.seconds = seconds();
        const Status written = checkpoints.write(m_comm, m_cut, m_parts, now);
        if (!m_comm.is_first()) return;
        const std::string step = std::to_string(now.iterations), before = m_newest ? "that of step " + std::to_string(*m_newest) + " stays" : "there is none before it";
        if (written && m_newest == now.iterations) return;
        if (m_options.note)
            m_options.note(written ? "checkpoint of step " + step + " in " + m_options.checkpoints.string() : "no checkpoint of step " + step + ", " + before + ": " + written.error().text());
        if (!written) return;
        m_newest = now.iterations;
        if (m_options.saved) m_options.saved(now.iterations);
    }

    Comm& m_comm;
    const Cut& m_cut;
    const std::vector<Part>& m_parts;
    const SplitOptions& m_options;
    double m_goal;
    Stand m_stand;
    sim::Executor m_executor;
    SplitCloth m_cloth;
    sim::Relaxing<SplitCloth> m_relaxing;
    std::optional<sim::Ending> m_end;
    double m_saved = 0;
    std::optional<std::size_t> m_newest;  ///< step of the newest checkpoint
    std::chrono::steady_clock::time_point m_start = std::chrono::steady_clock::now();
};

std::size_t points_of(const Cut& cut) {
    std::size_t points = 0;
    for (const std::uint32_t of_yarn : cut.points) points += of_yarn;
    return points;
}

Json run_key(const Design& design, const sim::Plan& plan, const Cut& cut) {
    return {{"design_sha256", design_sha256(design)}, {"scene_sha256", scene_sha256(design)}, {"points_per_key", plan.points_per_key},
            {"sample_spacing", plan.scene.sample_spacing}, {"points", points_of(cut)}, {"blocks", cut.blocks}, {"yarns", cut.points.size()}, {"plan_sha256", cut.sha256}};
}

/// Whether all ranks are about the same, `words`: a stale copy of a design on one machine is found before it does harm.
Status check_alike(Comm& comm, const std::string& words) {
    Comm::Packet letters;
    for (const char letter : sha256_hex(words)) letters.push_back(static_cast<double>(letter));
    Status status;
    if (comm.gather(letters).front() != letters) status = Error{ErrorCode::usage, "has another design or other options than the first process: all must be given the same", {}};
    return agreed(comm, status);
}

/// This rank's part of a plan, and what tells the run from any other.
struct Dealt {
    CutPlan plan;
    Json key;
};

Result<Dealt> deal(Comm& comm, const Design& design, const sim::PlanInStretches& plan, std::size_t points_a_block, const std::string& purpose) {
    Result<CutPlan> cut = cut_plan(plan, comm.rank(), comm.size(), points_a_block);
    WEAVE_CHECK_OK(agreed(comm, cut ? Status() : Status(cut.error())));
    Json key = run_key(design, plan.plan(), cut->cut);
    WEAVE_CHECK_OK(check_alike(comm, key.dump() + purpose));
    return Dealt{*std::move(cut), std::move(key)};
}

/// What must be the same on all ranks besides what is simulated.
std::string purpose_of(const SplitOptions& options) {
    return Json{options.residual.value_or(0), options.most_iterations, options.checkpoints.string(), options.checkpoint_every_s}.dump();
}

/// The checkpoint to go on from, if there is one, in a folder that is fit for more.
Result<std::optional<Stand>> newest(Comm& comm, const Dealt& dealt, const Checkpoints& checkpoints) {
    WEAVE_CHECK_OK(checkpoints.try_out(comm));
    return checkpoints.newest(comm, dealt.plan.cut, dealt.plan.parts);
}

Stand as_planned(const std::vector<Part>& parts) {
    Stand stand;
    for (const Part& part : parts) {
        for (const Point& point : part.own) stand.state.insert(stand.state.end(), point.planned.data(), point.planned.data() + 3);
    }
    return stand;
}

std::size_t points_of(const std::vector<Part>& parts) {
    std::size_t points = 0;
    for (const Part& part : parts) points += part.own.size();
    return points;
}

/// Whole numbers of all ranks, by name.
Json gathered(Comm& comm, const std::vector<std::pair<const char*, std::uint64_t>>& own) {
    Comm::Packet packet;
    for (const auto& [name, number] : own) packet.push_back(static_cast<double>(number));
    Json list = Json::array();
    for (const Comm::Packet& of_rank : comm.gather(packet)) {
        Json rank;
        for (std::size_t k = 0; k < own.size(); ++k) rank[own[k].first] = static_cast<std::uint64_t>(of_rank[k]);
        list.push_back(std::move(rank));
    }
    return list;
}

/// What each rank has: the balance of the work, and what it told others.
Json ranks_json(Comm& comm, const std::vector<Part>& parts, const SplitCloth& cloth) {
    std::size_t guests = 0;
    for (const auto& piece : cloth.pieces()) guests += piece->guests().size();
    const Comm::Traffic traffic = comm.traffic();
    return gathered(comm, {{"blocks", parts.size()}, {"points", points_of(parts)}, {"guests", guests}, {"messages", traffic.messages}, {"bytes", traffic.bytes},
                           {"gatherings", traffic.gatherings}, {"gathered_bytes", traffic.gathered_bytes}, {"peak_bytes", sim::peak_bytes()}});
}

Json report_of(Comm& comm, const Cut& cut, const std::vector<Part>& parts, const Outline& outline, const Measured& measured, SplitRun& run, double goal) {
    const sim::Relaxing<SplitCloth> relaxed = run.relaxed();
    const sim::Ending ending = run.ending();
    const std::string curvature = run.smallest_curvature();
    Json report{{"design_sha256", outline.bare.design_sha256},
                {"scene_sha256", outline.bare.scene_sha256},
                {"coverage", outline.coverage},
                {"solver", "relax"},
                {"backend", "cpu"},
                {"fidelity", std::string(sim::name_of(outline.fidelity))},
                {"points_per_key", outline.points_per_key},
                {"converged", ending == sim::Ending::converged},
                {"ending", std::string(sim::name_of(ending))},
                {"goal", goal},
                {"residual", relaxed.residual},
                {"reference_N", relaxed.reference_N},
                {"energy_N_mm", relaxed.energy},
                {"points", points_of(cut)},
                {"contacts", measured.contacts},
                {"iterations", run.iterations()},
                {"evaluations", run.evaluations()},
                {"seconds", run.seconds()},
                {"smallest_curvature", curvature},
                {"strain_deviation", {{"warp", measured.strain_deviation[0]}, {"weft", measured.strain_deviation[1]}}},
                {"order_kept", measured.lost == 0},
                {"crossings", outline.planned_crossings},
                {"lost_crossings", measured.lost},
                {"slid_crossings", measured.slid},
                {"max_overlap", measured.max_overlap},
                {"plan", outline.lines},
                {"peak_bytes", 0}};
    const Json ranks = ranks_json(comm, parts, run.cloth());
    for (const Json& rank : ranks) report["peak_bytes"] = std::max(report["peak_bytes"].get<std::uint64_t>(), rank.at("peak_bytes").get<std::uint64_t>());
    report["blocks"] = {{"rows", cut.blocks[0]}, {"columns", cut.blocks[1]}, {"laid_out", run.cloth().lays()}};
    report["ranks"] = ranks;
    return report;
}

}  // namespace

Result<Json> simulate_split(Comm& comm, const Design& design, sim::PlanInStretches plan, const SplitOptions& options, const std::filesystem::path& out) {
    WEAVE_CHECK_OK(agreed(comm, comm.is_first() ? check_writable(out) : Status()));
    WEAVE_TRY(const Dealt dealt, deal(comm, design, plan, options.points_a_block, purpose_of(options)));
    const auto& [cut, parts] = dealt.plan;
    const Outline outline = outline_of(design, plan, parts);
    const double goal = options.residual.value_or(outline.goal);
    plan = {};
    std::optional<Checkpoints> checkpoints;
    std::optional<Stand> before;
    if (!options.checkpoints.empty()) {
        checkpoints.emplace(options.checkpoints, dealt.key);
        WEAVE_TRY(before, newest(comm, dealt, *checkpoints));
    }
    std::optional<std::size_t> step;
    if (before) step = before->iterations;
    if (before && comm.is_first() && options.note) options.note("going on from the checkpoint of step " + std::to_string(*step));
    if (before && comm.is_first() && options.saved) options.saved(*step);
    SplitRun run(comm, cut, parts, options, goal, before ? *std::move(before) : as_planned(parts));
    run.relax(checkpoints ? &*checkpoints : nullptr, step);
    const Measured measured = measure(comm, cut, parts, outline, run.cloth());
    Json report = report_of(comm, cut, parts, outline, measured, run, goal);
    WEAVE_CHECK_OK(write_split(comm, design, cut, parts, outline, measured, run.cloth(), report, out));
    return report;
}

Result<Json> explain_split(Comm& comm, const Design& design, const sim::PlanInStretches& plan, std::size_t points_a_block) {
    WEAVE_TRY(const Dealt dealt, deal(comm, design, plan, points_a_block, "explain"));
    const auto& [cut, parts] = dealt.plan;
    Json ranks = gathered(comm, {{"blocks", parts.size()}, {"points", points_of(parts)}, {"peak_bytes", sim::peak_bytes()}});
    return Json{{"points", points_of(cut)}, {"blocks", {{"rows", cut.blocks[0]}, {"columns", cut.blocks[1]}}}, {"ranks", std::move(ranks)}};
}

}  // namespace weave::ranks
