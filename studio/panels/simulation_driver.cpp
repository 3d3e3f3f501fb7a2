#include <studio/panels/simulation_driver.hpp>

#include <weave/block/changes.hpp>
#include <weave/design/document.hpp>
#include <weave/design/edit.hpp>
#include <weave/design/evaluate.hpp>
#include <weave/design/tree.hpp>

#include <algorithm>
#include <cmath>
#include <studio/jobs/background.hpp>
#include <studio/jobs/local_relaxation.hpp>
#include <studio/jobs/remote_relaxation.hpp>
#include <studio/panels/simulation_system_group.hpp>

namespace weave::studio {

namespace {

/// More flips are not led at once: each takes some tenths of a second, and to lay the cloth out anew is quicker.
constexpr std::size_t most_led = 64;

/// The blocks that the cloth is made from: others may lie beside it.
std::vector<std::pair<std::string, NodePtr>> parts_of_cloth(const Design& design) {
    std::vector<std::pair<std::string, NodePtr>> parts;
    for (const std::string& name : bottom_up(design, design.root)) parts.emplace_back(name, design.blocks.at(name));
    std::ranges::sort(parts, {}, [](const auto& part) { return part.first; });
    return parts;
}

/// Whether all that the two cloths are made from fits, one by one.
template <class Fits>
bool all_blocks(const Design& one, const Design& other, Fits fits) {
    const auto parts = parts_of_cloth(one), others = parts_of_cloth(other);
    return std::equal(parts.begin(), parts.end(), others.begin(), others.end(),
                      [&](const auto& a, const auto& b) {
                          // Nodes never change, so those that are one object need not be looked into.
                          return a.first == b.first && (a.second == b.second || fits(*a.second, *b.second));
                      });
}

bool same_blocks(const Design& one, const Design& other) {
    return all_blocks(one, other, [](const Node& a, const Node& b) { return a == b; });
}

/// But for flips, which can be led.
bool same_sources(const Design& one, const Design& other) {
    return all_blocks(one, other, [](const Node& a, const Node& b) { return Node{a.source, {}} == Node{b.source, {}}; });
}

Flip opposite(const Flip& flip) {
    return {flip.pick, flip.end, !flip.weft_over};
}

/// What leads the cloth of the one design to that of the other; nothing where that is too much, or there is no cloth.
std::optional<std::vector<Flip>> flips_between(const Design& before, const Design& after) {
    Evaluator evaluator;
    const auto was = evaluator.evaluate(before), is = evaluator.evaluate(after);
    if (!was || !is) return {};
    return flips_between(*was->block, *is->block, most_led);
}

/// Whether a run of the one shows the other, but for what can be led into it.
bool same_cloth(const Design& one, const Design& other) {
    Scene led = one.scene;
    const bool same_feed = led.weft.strain.has_value() == other.scene.weft.strain.has_value();
    led.warp = other.scene.warp;
    led.weft = other.scene.weft;
    led.pins = other.scene.pins;
    led.fields = other.scene.fields;
    return same_feed && led == other.scene && one.root == other.root && one.warp == other.warp &&
           one.weft == other.weft && same_sources(one, other);
}

/// What of these values is not as it was.
SystemScene changed(const SystemScene& now, const SystemScene& before) {
    SystemScene list;
    if (now.strain && now.strain != before.strain) list.strain = now.strain;
    if (now.stiffness_scale != before.stiffness_scale) list.stiffness_scale = now.stiffness_scale;
    if (now.radius_scale != before.radius_scale) list.radius_scale = now.radius_scale;
    return list;
}

}  // namespace

void SimulationDriver::start(const Design& design, const sim::RunRequest& request,
                             const std::optional<ServerWish>& server) {
    if (server)
        m_run = std::make_unique<RemoteRelaxation>(*server);
    else
        m_run = std::make_unique<LocalRelaxation>();
    m_state = {};
    m_plan.reset();
    m_started = m_wanted = design;
    m_highest = 0;
    m_is_to_run = false;
    forget_flips();
    connect_run();
    Q_EMIT begun();
    m_run->start(design, request);
}

void SimulationDriver::connect_run() {
    Relaxation* run = m_run.get();
    connect(run, &Relaxation::phase_changed, this, &SimulationDriver::enter);
    connect(run, &Relaxation::planned, this, [this](const auto& plan) {
        m_plan = plan;
        Q_EMIT planned();
    });
    connect(run, &Relaxation::laid_out, this, &SimulationDriver::laid_out);
    connect(run, &Relaxation::frame_came, this, &SimulationDriver::frame_came);
    connect(run, &Relaxation::progressed, this, &SimulationDriver::take);
    connect(run, &Relaxation::ended, this, [this](const auto& yarns) {
        m_state.yarns = named(yarns);
        Q_EMIT yarns_came(m_state.yarns);
        Q_EMIT state_changed();
    });
    connect(run, &Relaxation::inspected, this, [this](const auto&, const auto& inspection) {
        m_state.inspection = inspection;
        Q_EMIT state_changed();
    });
    connect(run, &Relaxation::flip_ended, this, &SimulationDriver::take_flip);
    connect(run, &Relaxation::refused, this, &SimulationDriver::refused);
    connect(run, &Relaxation::troubled, this, &SimulationDriver::troubled);
    connect(run, &Relaxation::failed, this, [this](const Error& error) {
        m_state.error = error;
        Q_EMIT state_changed();
    });
}

/// A run names its yarns by the flips that it made itself. The design has come to the same cloth in its own way, by undo or by one flip
/// of a block that lies in it many times: once all flips are made, these are yarns of that design.
std::shared_ptr<const Yarns> SimulationDriver::named(const std::shared_ptr<const Yarns>& yarns) const {
    const bool shows_started = m_asked.empty() && m_led.empty() && m_refused.empty();
    const std::string name = design_sha256(m_started);
    if (!shows_started || yarns->design_sha256 == name) return yarns;
    auto renamed = std::make_shared<Yarns>(*yarns);
    renamed->design_sha256 = name;
    return renamed;
}

void SimulationDriver::enter(RunPhase phase) {
    m_state.phase = phase;
    if (phase != RunPhase::planning && phase != RunPhase::paused) m_is_to_run = false;
    if (phase == RunPhase::running) {
        m_state.yarns.reset();
        m_state.inspection.reset();
    }
    Q_EMIT state_changed();
}

void SimulationDriver::take(const Progress& progress) {
    m_state.progress = progress;
    for (const ResidualPoint& point : progress.history) m_highest = std::max(m_highest, point.residual);
    if (!progress.history.empty()) Q_EMIT moved(progress.history);
    Q_EMIT state_changed();
}

/// What was flipped in the run is what the design gets as an edit: after that they show the same. What the
/// design had before the run is no edit once more.
void SimulationDriver::take_flip(const Flip& flip, bool done, const QString& reason) {
    const auto led = std::find(m_led.begin(), m_led.end(), flip);
    if (led == m_led.end()) {
        static_cast<void>(std::erase(m_asked, flip));
        if (done) static_cast<void>(apply_edit(m_started, PutFlip{m_started.root, flip}));
        Q_EMIT flip_ended(flip, done, reason);
        return;
    }
    m_led.erase(led);
    if (done) return;
    // A crossing that the run did not turn lies as before, so to turn it back is refused too: then the two agree again.
    if (std::erase(m_refused, opposite(flip)) == 0) {
        m_refused.push_back(flip);
        Q_EMIT flip_refused(flip, reason);
    }
    Q_EMIT behind_changed();
}

void SimulationDriver::run() {
    if (!is_open()) return;
    m_is_to_run = true;
    m_run->run();
    Q_EMIT state_changed();
}

void SimulationDriver::pause() {
    m_is_to_run = false;
    if (is_open()) m_run->pause();
    Q_EMIT state_changed();
}

void SimulationDriver::step(std::uint64_t steps) {
    if (is_open()) m_run->step(steps);
}

void SimulationDriver::stop() {
    if (is_open()) m_run->stop();
}

void SimulationDriver::flip(const Flip& flip) {
    if (!is_open()) return;
    m_asked.push_back(flip);
    m_run->flip(flip);
}

void SimulationDriver::leave() {
    m_run.reset();
    m_state = {};
    m_plan.reset();
    m_is_to_run = false;
    forget_flips();
    Q_EMIT begun();
}

void SimulationDriver::forget_flips() {
    m_asked.clear();
    m_led.clear();
    m_refused.clear();
    m_is_other = m_looks = false;
    ++m_runs;
}

void SimulationDriver::follow(const Design& design) {
    if (m_state.phase == RunPhase::idle) return;
    m_wanted = design;
    m_is_other = !same_cloth(m_started, design);
    if (m_is_other) return;
    if (!is_open()) {
        m_is_other = m_started.scene != design.scene || !same_blocks(m_started, design);
        return;
    }
    lead_parameters(design.scene);
    if (m_started.scene.pins != design.scene.pins) m_run->hold(design.scene.pins);
    if (m_started.scene.fields != design.scene.fields) m_run->push(design.scene.fields);
    m_started.scene = design.scene;
    look_for_flips();
}

/// A large cloth takes a while to make. What changes meanwhile is looked for afterwards.
void SimulationDriver::look_for_flips() {
    if (m_looks || same_blocks(m_started, m_wanted)) return;
    m_looks = true;
    in_background(
        this, [before = m_started, after = m_wanted] { return flips_between(before, after); },
        [this, before = m_started, after = m_wanted, run = m_runs](const std::optional<std::vector<Flip>>& flips) {
            if (run == m_runs) take_flips(before, after, flips);
        });
}

void SimulationDriver::take_flips(const Design& before, const Design& after,
                                  const std::optional<std::vector<Flip>>& flips) {
    m_looks = false;
    if (is_open() && same_blocks(before, m_started)) {  // no flip asked for in the run came between
        for (const Flip& flip : flips.value_or(std::vector<Flip>())) lead(flip);
        if (flips) m_started.blocks = after.blocks;
        m_is_other = !flips && same_blocks(after, m_wanted);
    }
    if (!m_is_other) follow(m_wanted);
    Q_EMIT behind_changed();
}

void SimulationDriver::lead(const Flip& flip) {
    m_led.push_back(flip);
    if (std::erase(m_asked, flip) == 0) m_run->flip(flip);
}

void SimulationDriver::lead_parameters(const Scene& scene) {
    const auto of = [&](const SystemScene& now, const SystemScene& before, System system) {
        return changed(with_usual_values(now, system), with_usual_values(before, system));
    };
    m_run->set_parameters(of(scene.warp, m_started.scene.warp, System::warp),
                          of(scene.weft, m_started.scene.weft, System::weft));
}

std::optional<double> SimulationDriver::share_done() const {
    const Progress& progress = m_state.progress;
    if (m_state.phase == RunPhase::at_rest) return 1;
    if (!(progress.residual > 0) || !(progress.goal > 0) || !(m_highest > progress.goal)) return {};
    return std::clamp(std::log(m_highest / progress.residual) / std::log(m_highest / progress.goal), 0.0,
                      1.0);
}

}  // namespace weave::studio
