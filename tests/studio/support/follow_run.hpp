#pragma once

#include <weave/core/instrumented.hpp>
#include <weave/samples/samples.hpp>

#include <QtTest>

#include <catch2/catch.hpp>

#include <functional>
#include <memory>
#include <optional>
#include <studio/jobs/relaxation.hpp>
#include <vector>

namespace weave::studio::test {

/// How long a test waits for what must come.
constexpr int patience_ms = is_instrumented ? 1'200'000 : 180'000;

inline sim::RunRequest request_at(sim::Fidelity fidelity) {
    sim::RunRequest request;
    request.plan.fidelity = fidelity;
    request.goal.most_iterations = wire::most_number;
    return request;
}

inline Design sample(const char* name) {
    return find_sample(name)->make();
}

/// All that a run tells, as it comes.
class FollowedRun {
  public:
    explicit FollowedRun(Relaxation& run) : m_run(run) {
        QObject::connect(&run, &Relaxation::phase_changed, &m_context,
                         [this](RunPhase phase) { phases.push_back(phase); });
        QObject::connect(&run, &Relaxation::planned, &m_context, [this](const auto& one) { plan = one; });
        QObject::connect(&run, &Relaxation::laid_out, &m_context,
                         [this](const auto& one) { layouts.push_back(one); });
        QObject::connect(&run, &Relaxation::frame_came, &m_context, [this](const auto& one) {
            ++frames;
            CHECK((!frame || one->head.number > frame->head.number));
            REQUIRE_FALSE(layouts.empty());
            CHECK(one->head.layout == layouts.back()->layout);
            frame = one;
        });
        QObject::connect(&run, &Relaxation::progressed, &m_context, [this](const Progress& one) {
            history.insert(history.end(), one.history.begin(), one.history.end());
            progress = one;
        });
        QObject::connect(&run, &Relaxation::ended, &m_context,
                         [this](const auto& one) { yarns.push_back(one); });
        QObject::connect(&run, &Relaxation::inspected, &m_context,
                         [this](const auto&, const auto& one) { inspection = one; });
        QObject::connect(&run, &Relaxation::flip_ended, &m_context,
                         [this](const Flip& flip, bool done, const QString& reason) {
                             flips.push_back({flip, done, reason.toStdString()});
                         });
        QObject::connect(&run, &Relaxation::parameters_arrived, &m_context, [this] { ++arrivals; });
        QObject::connect(&run, &Relaxation::refused, &m_context,
                         [this](const Error& one) { refusals.push_back(one); });
        QObject::connect(&run, &Relaxation::troubled, &m_context,
                         [this](const QString& words) { troubles.push_back(words); });
        QObject::connect(&run, &Relaxation::failed, &m_context, [this](const Error& one) { error = one; });
    }

    [[nodiscard]] bool until(const std::function<bool()>& enough) const {
        return QTest::qWaitFor([&] { return enough() || error; }, patience_ms) && enough();
    }
    [[nodiscard]] bool until_phase(RunPhase phase) const {
        return until([&] { return m_run.phase() == phase; });
    }
    /// Until it stands in this phase and its yarns have come.
    [[nodiscard]] bool until_yarns(RunPhase phase, std::size_t count) const {
        return until([&] { return m_run.phase() == phase && yarns.size() >= count; });
    }

    std::vector<RunPhase> phases;
    std::shared_ptr<const PlanSummary> plan;
    std::vector<std::shared_ptr<const YarnLayout>> layouts;
    std::shared_ptr<const Frame> frame;
    std::size_t frames = 0, arrivals = 0;
    Progress progress;
    std::vector<ResidualPoint> history;
    std::vector<std::shared_ptr<const Yarns>> yarns;
    std::shared_ptr<const Inspection> inspection;
    std::vector<FlipEnd> flips;
    std::vector<Error> refusals;
    std::vector<QString> troubles;
    std::optional<Error> error;

  private:
    Relaxation& m_run;
    QObject m_context;
};

/// Yarns that must be the same to the last bit.
inline void check_same(const Yarns& one, const Yarns& other) {
    REQUIRE(one.yarns.size() == other.yarns.size());
    std::size_t different = 0;
    for (std::size_t y = 0; y < one.yarns.size(); ++y) {
        different += one.yarns[y].spline.control == other.yarns[y].spline.control ? 0 : 1;
        different += one.yarns[y].radius_mm == other.yarns[y].radius_mm ? 0 : 1;
    }
    CHECK(different == 0);
    for (const char* member :
         {"iterations", "residual", "energy_N_mm", "converged", "scene_sha256", "design_sha256"}) {
        INFO(member);
        CHECK(one.report.at(member) == other.report.at(member));
    }
}

}  // namespace weave::studio::test
