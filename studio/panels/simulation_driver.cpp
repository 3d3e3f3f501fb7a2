#include <studio/panels/simulation_driver.hpp>

#include <weave/design/edit.hpp>

#include <algorithm>
#include <cmath>
#include <studio/jobs/local_relaxation.hpp>
#include <studio/jobs/remote_relaxation.hpp>
#include <studio/panels/simulation_system_group.hpp>

namespace weave::studio {

namespace {

/// Nodes never change, so those that are one object need not be looked into.
bool same_source(const NodePtr& one, const NodePtr& other) {
    return one == other || Node{one->source, {}} == Node{other->source, {}};
}

/// But for the flips of the cloth itself, which can be led.
bool same_blocks(const Design& one, const Design& other) {
    return std::equal(one.blocks.begin(), one.blocks.end(), other.blocks.begin(), other.blocks.end(),
                      [&](const auto& a, const auto& b) {
                          if (a.first != b.first) return false;
                          if (a.first == one.root) return same_source(a.second, b.second);
                          return a.second == b.second || *a.second == *b.second;
                      });
}

const std::vector<Flip>& flips_of(const Design& design) {
    static const std::vector<Flip> none;
    const auto cloth = design.blocks.find(design.root);
    return cloth == design.blocks.end() ? none : cloth->second->flips;
}

bool same_place(const Flip& one, const Flip& other) {
    return one.pick == other.pick && one.end == other.end;
}

/// The flip of a crossing that counts: of several at one place the last.
const Flip* last_at(const std::vector<Flip>& flips, const Flip& place) {
    const auto found = std::find_if(flips.rbegin(), flips.rend(), [&](const Flip& one) { return same_place(one, place); });
    return found == flips.rend() ? nullptr : &*found;
}

Flip opposite(const Flip& flip) {
    return {flip.pick, flip.end, !flip.weft_over};
}

/// What leads from the crossings as the one has them to those of the other: a flip that is gone goes the other way.
std::vector<Flip> flips_between(const std::vector<Flip>& before, const std::vector<Flip>& now) {
    std::vector<Flip> between;
    for (const Flip& flip : before) {
        if (last_at(now, flip) == nullptr && last_at(before, flip) == &flip) between.push_back(opposite(flip));
    }
    for (const Flip& flip : now) {
        const Flip* was = last_at(before, flip);
        if (last_at(now, flip) == &flip && (was == nullptr || *was != flip)) between.push_back(flip);
    }
    return between;
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
           one.weft == other.weft && same_blocks(one, other);
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
    m_started = design;
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
        m_state.yarns = yarns;
        Q_EMIT yarns_came(yarns);
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
    m_refused.push_back(flip);
    Q_EMIT fell_behind(flip, reason);
}

bool SimulationDriver::is_refused(const Flip& flip) const {
    return std::any_of(m_refused.begin(), m_refused.end(), [&](const Flip& one) { return same_place(one, flip); });
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
}

bool SimulationDriver::follow(const Design& design) {
    if (m_state.phase == RunPhase::idle) return false;
    if (!same_cloth(m_started, design)) return true;
    if (!is_open()) return m_started.scene != design.scene || !flips_between(flips_of(m_started), flips_of(design)).empty();
    lead_flips(design);
    lead_parameters(design.scene);
    if (m_started.scene.pins != design.scene.pins) m_run->hold(design.scene.pins);
    if (m_started.scene.fields != design.scene.fields) m_run->push(design.scene.fields);
    m_started.scene = design.scene;
    return !m_refused.empty();
}

/// A crossing that the run did not turn lies as before: turned back in the design, the two agree again, and
/// there is nothing to lead.
void SimulationDriver::lead_flips(const Design& design) {
    for (const Flip& flip : flips_between(flips_of(m_started), flips_of(design))) {
        if (std::erase_if(m_refused, [&](const Flip& one) { return one == opposite(flip); }) > 0) continue;
        if (is_refused(flip)) continue;
        m_led.push_back(flip);
        if (std::erase(m_asked, flip) == 0) m_run->flip(flip);
    }
    m_started.blocks = design.blocks;
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
