#include <weave/sim/flips.hpp>

#include <weave/sim/neighbourhood.hpp>
#include <weave/sim/order.hpp>
#include <weave/sim/relax.hpp>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <optional>

namespace weave::sim {

namespace {

/// Shares of contact that come back one after the other, before all of it does.
constexpr double contact_shares[]{0.02, 0.2};
/// The spring has done its work when the height is within this share of what it leads to.
constexpr double height_share = 0.1;
constexpr double stage_residual = 3e-2;
constexpr std::size_t spring_iterations = 200, contact_iterations = 20, last_iterations = 60, wide_iterations = 300;
/// How far around the crossing yarns move, in spacings of the cloth: while the two change sides, and then while the cloth
/// there comes to rest, so that the rest of it has little left to do.
constexpr double near_spacings = 1.5, wide_spacings = 5;

std::vector<Spline> splines_of(const SimScene& scene, const std::vector<std::size_t>& curve_of, std::size_t curves) {
    std::vector<Spline> splines(curves);
    for (std::size_t y = 0; y < scene.yarns.size(); ++y)
        splines[curve_of[y]] = {scene.yarns[y].control, scene.yarns[y].is_periodic, scene.yarns[y].shift};
    return splines;
}

/// One flip under way.
class Flipping {
  public:
    Flipping(const SimScene& scene, const ClothCurves& curves, const std::vector<std::size_t>& curve_of,
             const Crossing& crossing, bool weft_over, double residual, const Executor& executor,
             const std::function<bool()>& go_on)
        : m_scene(scene), m_curves(curves), m_curve_of(curve_of), m_crossing(crossing), m_over(weft_over),
          m_residual(residual), m_executor(executor), m_go_on(go_on) {}

    /// Whether the crossing lies as asked for in the end; fills in what is known.
    bool run(FlipResult& result) {
        const auto found = find();
        if (!found) return give_up(result, "the yarns no longer cross near their planned place");
        prepare(*found);
        stage(0, spring_iterations, result);
        for (const double share : contact_shares) stage(share, contact_iterations, result);
        settle(last_iterations, stage_residual, result);
        m_moving_mm = wide_spacings * spacing();
        settle(wide_iterations, m_residual, result);
        if (m_stopped) return give_up(result, "it was stopped");
        const auto ended = find();
        if (!ended) return give_up(result, "the yarns slid off one another");
        result.height_mm = ended->height_mm;
        if ((ended->height_mm > 0) != m_over)
            return give_up(result, "other yarns keep the two from changing sides");
        return true;
    }

    [[nodiscard]] const std::vector<SimYarn>& yarns() const { return m_scene.yarns; }

  private:
    static bool give_up(FlipResult& result, const char* reason) {
        result.reason = reason;
        return false;
    }

    [[nodiscard]] std::optional<CrossingSpot> find() const {
        return find_crossing(m_curves, splines_of(m_scene, m_curve_of, m_curves.yarns.size()), m_crossing);
    }

    [[nodiscard]] std::size_t yarn_of(std::size_t curve) const {
        return static_cast<std::size_t>(std::find(m_curve_of.begin(), m_curve_of.end(), curve) - m_curve_of.begin());
    }

    void prepare(const CrossingSpot& found) {
        m_pair.yarn = {yarn_of(m_crossing.weft), yarn_of(m_crossing.warp)};
        double thickest = 0;
        for (const SimYarn& yarn : m_scene.yarns) thickest = std::max(thickest, yarn.radius_mm);
        const SimYarn &weft = m_scene.yarns[m_pair.yarn[0]], &warp = m_scene.yarns[m_pair.yarn[1]];
        const double reach = weft.radius_mm + warp.radius_mm;
        m_stretch_mm = 2 * std::max(thickest, reach / 2);
        m_pair.height_mm = (m_over ? 1 : -1) * reach;
        // Ten times what bends or stretches either yarn over the way that it has to go.
        double stiffness = 0;
        for (const SimYarn* yarn : {&weft, &warp}) {
            const double tension = yarn->stretch_N * std::max(yarn->strain - 1, 0.02);
            stiffness = std::max({stiffness, tension / m_stretch_mm, yarn->bending_N_mm2 / std::pow(m_stretch_mm, 3)});
        }
        m_pair.spring_N_per_mm = 10 * stiffness;
        const Spline of{weft.control, weft.is_periodic, weft.shift};
        m_place = of.place(found.weft_at);
        m_moving_mm = near_spacings * spacing();
    }

    [[nodiscard]] double spacing() const { return std::max({m_curves.dx_mm, m_curves.dy_mm, m_stretch_mm}); }

    /// The transition as the neighbourhood has it, whose yarns are pieces; nothing where a piece does not hold its crossing.
    [[nodiscard]] std::optional<TransitionPair> pair_in(const Neighbourhood& part) const {
        TransitionPair pair = m_pair;
        for (std::size_t side = 0; side < 2; ++side) {
            bool is_found = false;
            for (std::size_t k = 0; k < part.pieces.size() && !is_found; ++k) {
                if (part.pieces[k].yarn != m_pair.yarn[side]) continue;
                const SimYarn &whole = m_scene.yarns[m_pair.yarn[side]], &piece = part.scene.yarns[k];
                const auto points = static_cast<double>(piece.control.size()), all = static_cast<double>(whole.control.size());
                double at = m_pair.at[side] - static_cast<double>(part.pieces[k].first);
                if (whole.is_periodic && !piece.is_periodic) at -= all * std::floor(at / all);
                is_found = piece.is_periodic || (at > 0 && at < points - 1);
                pair.at[side] = at;
                pair.yarn[side] = k;
                pair.reach[side] = std::min(m_pair.reach[side], 0.45 * (points - 1));
            }
            if (!is_found) return {};
        }
        return pair;
    }

    /// Relaxes what may move with the spring and a share of the pair's contact.
    void stage(double contact, std::size_t most_iterations, FlipResult& result) {
        const auto found = find();
        if (!found || m_stopped) return;
        m_pair.at = {found->weft_at, found->warp_at};
        m_pair.contact = contact;
        for (std::size_t side = 0; side < 2; ++side) {
            const SimYarn& yarn = m_scene.yarns[m_pair.yarn[side]];
            const Spline of{yarn.control, yarn.is_periodic, yarn.shift};
            m_pair.reach[side] = std::max(0.5, m_stretch_mm / std::max(1e-9, of.tangent(m_pair.at[side]).norm()));
        }
        m_leads = true;
        settle(most_iterations, stage_residual, result);
        m_leads = false;
    }

    /// Whether the spring has led the two to their heights, all contact being off.
    [[nodiscard]] static bool is_lifted(const Fabric<double>& fabric, const std::vector<double>& state) {
        if (!fabric.scene().transition || fabric.scene().transition->contact > 0) return false;
        const TransitionPair& pair = *fabric.scene().transition;
        double height[2];
        for (std::size_t side = 0; side < 2; ++side) {
            const SimYarn& yarn = fabric.scene().yarns[pair.yarn[side]];
            const YarnPlace& place = fabric.yarns()[pair.yarn[side]];
            Spline spline{{}, yarn.is_periodic, yarn.shift};
            for (std::size_t i = 0; i < place.points; ++i) spline.control.push_back(load(&state[3 * (place.first_slot + 1 + i)]));
            height[side] = spline.place(pair.at[side]).z();
        }
        return std::abs(height[0] - height[1] - pair.height_mm) < height_share * std::abs(pair.height_mm);
    }

    void settle(std::size_t most_iterations, double residual, FlipResult& result) {
        if (m_stopped) return;
        Neighbourhood part = neighbourhood(m_scene, m_place, m_moving_mm);
        if (m_leads) part.scene.transition = pair_in(part);
        if (m_leads && !part.scene.transition) return;
        const Fabric<double> fabric(part.scene);
        Energy<double> energy(fabric, m_executor);
        std::vector<double> state = fabric.state();
        RelaxOptions options;
        options.residual = residual;
        options.most_iterations = most_iterations;
        options.leaves_saddles = false;  // the cloth as a whole comes to rest afterwards
        options.watch = [&](const Progress&) {
            m_stopped = m_go_on && !m_go_on();
            return !m_stopped && !is_lifted(fabric, state);
        };
        result.iterations += relax(energy, state, options).iterations;
        std::vector<std::vector<Vec3>> control = fabric.control(state);
        for (std::size_t k = 0; k < control.size(); ++k) part.scene.yarns[k].control = std::move(control[k]);
        put_back(part, m_scene);
    }

    SimScene m_scene;
    const ClothCurves& m_curves;
    const std::vector<std::size_t>& m_curve_of;
    Crossing m_crossing;
    bool m_over, m_leads = false, m_stopped = false;  ///< the spring leads the two
    double m_residual;
    const Executor& m_executor;
    const std::function<bool()>& m_go_on;
    TransitionPair m_pair;
    Vec3 m_place{0, 0, 0};
    double m_moving_mm = 0;   ///< around that place
    double m_stretch_mm = 0;  ///< half the stretches without contact
};

/// The crossings of the plan that a pixel of the card stands for: one, or two where the pick has two feeders.
std::vector<std::size_t> crossings_of(const ClothCurves& curves, const std::vector<std::size_t>& curve_of, const Flip& flip) {
    std::vector<std::size_t> found;
    for (std::size_t c = 0; c < curves.crossings.size(); ++c) {
        const Crossing& crossing = curves.crossings[c];
        if (crossing.pick != flip.pick || crossing.end != flip.end || crossing.weft_over == flip.weft_over) continue;
        const auto takes_part = [&](std::size_t curve) { return std::ranges::find(curve_of, curve) != curve_of.end(); };
        if (takes_part(crossing.weft) && takes_part(crossing.warp)) found.push_back(c);
    }
    return found;
}

}  // namespace

FlipResult flip_relaxed(SimScene& scene, ClothCurves& curves, const std::vector<std::size_t>& curve_of, const Flip& flip,
                        double residual, const Executor& executor, const std::function<bool()>& go_on) {
    const auto start = std::chrono::steady_clock::now();
    FlipResult result;
    result.flip = flip;
    SimScene changed = scene;
    const std::vector<std::size_t> crossings = crossings_of(curves, curve_of, flip);
    result.done = !crossings.empty();
    if (crossings.empty()) result.reason = "no two yarns of what is simulated cross there";
    for (const std::size_t c : crossings) {
        Flipping flipping(changed, curves, curve_of, curves.crossings[c], flip.weft_over, residual, executor, go_on);
        result.done = result.done && flipping.run(result);
        if (!result.done) break;
        for (std::size_t y = 0; y < changed.yarns.size(); ++y) changed.yarns[y].control = flipping.yarns()[y].control;
    }
    if (result.done) {
        scene = std::move(changed);
        for (const std::size_t c : crossings) curves.crossings[c].weft_over = flip.weft_over;
    }
    result.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    return result;
}

}  // namespace weave::sim
