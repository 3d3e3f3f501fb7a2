#pragma once

#include <weave/sim/resolution.hpp>
#include <weave/wire/message.hpp>
#include <weave/wire/message_form.hpp>

#include <limits>

// Private. What each message and each of its parts is made of (message_form.hpp); PROTOCOL.md says the same in words.

namespace weave::wire::form {

// ---- Words ----

inline const Names fidelity_names{"draft", "standard", "reference"};
inline const Names solver_names{"relax", "paper"};
inline const Names weft_mode_names{"periodic", "wraparound"};
inline const Names system_names{"warp", "weft"};  ///< as System has them
inline const Names phase_names{"running", "paused", "at_rest"};
inline const Names job_phase_names{"waiting", "running", "done", "failed", "cancelled"};
inline const Names why_names{"closed", "failed", "expired"};
inline const Names error_names{"usage", "bad input", "invalid", "refused", "system"};  ///< as kind_of() has them

// ---- Limits ----

constexpr std::size_t most_versions = 64, most_jobs = 10'000, most_sessions = 1'000, most_yarns = std::size_t{1} << 18;
constexpr std::size_t most_changes = 65'536;  ///< of pins, fields, held crossings or flips in one message
constexpr std::size_t longest_name = 100, longest_title = 1000, longest_words = 65'536;
constexpr std::uint64_t most_yarn = static_cast<std::uint64_t>(most_yarn_number);
constexpr std::uint64_t most_row = most_yarn;
constexpr std::uint64_t most_points = most_frame_bytes;
constexpr double most_seconds_told = 1e9;
constexpr Range amount_range{0, std::numeric_limits<double>::max()}, factor_range{1e-9, 1e9}, strain_range{1, 2};

/// Values of a row or a list.
struct Numbers {
    double low, high;
    [[nodiscard]] std::optional<double> read(const Json& item) const {
        if (!item.is_number()) return {};
        const auto value = item.get<double>();
        if (!(value >= low && value <= high)) return {};
        return value;
    }
    [[nodiscard]] Json written(double value) const { return value; }
};
struct Counts {
    std::uint64_t low, high;
    [[nodiscard]] std::optional<std::uint64_t> read(const Json& item) const {
        if (!item.is_number_unsigned()) return {};
        const auto value = item.get<std::uint64_t>();
        if (value < low || value > high) return {};
        return value;
    }
    [[nodiscard]] Json written(std::uint64_t value) const { return value; }
};
struct Flags {
    [[nodiscard]] std::optional<bool> read(const Json& item) const {
        if (!item.is_boolean()) return {};
        return item.get<bool>();
    }
    [[nodiscard]] Json written(bool value) const { return value; }
};
/// A force for each mm of rim, or null where the period is given.
struct RimForces {
    [[nodiscard]] std::optional<std::optional<double>> read(const Json& item) const {
        if (item.is_null()) return std::optional<double>{};
        const auto force = Numbers{-1e9, 1e9}.read(item);
        if (!force) return {};
        return force;
    }
    [[nodiscard]] Json written(const std::optional<double>& value) const { return value ? Json(*value) : Json(nullptr); }
};
/// A pick and an end.
struct Crossings {
    using Pair = std::array<std::size_t, 2>;
    [[nodiscard]] std::optional<Pair> read(const Json& item) const {
        const Counts counts{0, most_yarn};
        if (!item.is_array() || item.size() != 2) return {};
        const auto pick = counts.read(item[0]), end = counts.read(item[1]);
        if (!pick || !end) return {};
        return Pair{*pick, *end};
    }
    [[nodiscard]] Json written(const Pair& pair) const { return Json::array({pair[0], pair[1]}); }
};

// ---- Members that are the same in many places ----

template <class Form, class T>
void maybe_number(Form& form, const char* key, T& value, Range range) {
    form.maybe(key, value, [&](auto& inner, auto& number) { inner.number(key, number, range); });
}
template <class Form, class T>
void maybe_count(Form& form, const char* key, T& value, std::uint64_t low = 0, std::uint64_t high = most_number) {
    form.maybe(key, value, [&](auto& inner, auto& count) { inner.count(key, count, low, high); });
}
template <class Form, class T>
void maybe_request(Form& form, T& value) {
    form.maybe("request", value, [](auto& inner, auto& request) { inner.request(request); });
}
template <class Form, class M>
void ask(Form& form, M& message) {
    form.request(message.request);
    form.count("session", message.session, 1);
}
template <class Form, class M>
void event(Form& form, M& message) {
    form.count("session", message.session, 1);
    form.count("seq", message.seq, 1);
}
template <class Form, class M>
void event_at_step(Form& form, M& message) {
    event(form, message);
    form.count("step", message.step);
}

// ---- Parts ----

template <class Form, Either<Error> M>
void describe(Form& form, M& error) {
    form.word("kind", error.code, error_names);
    form.text("where", error.where, longest_words);
    form.text("message", error.message, longest_words);
}
template <class Form, class T>
void maybe_error(Form& form, T& value) {
    form.maybe("error", value, [](auto& inner, auto& error) { inner.part("error", error); });
}
template <class Form, Either<Region> M>
void describe(Form& form, M& region) {
    form.count("first_row", region.first_row, 0, most_row);
    form.count("last_row", region.last_row, 0, most_row);
    form.count("first_column", region.first_column, 0, most_row);
    form.count("last_column", region.last_column, 0, most_row);
}
template <class Form, Either<SystemScene> M>
void describe(Form& form, M& system) {
    maybe_number(form, "strain", system.strain, strain_range);
    maybe_number(form, "stiffness_scale", system.stiffness_scale, factor_range);
    maybe_number(form, "radius_scale", system.radius_scale, factor_range);
}
template <class Form, Either<Pin> M>
void describe(Form& form, M& pin) {
    if constexpr (Form::reads) {
        System system = System::warp;
        form.word("system", system, system_names);
        pin.is_pick = system == System::weft;
    } else {
        form.word("system", pin.is_pick ? System::weft : System::warp, system_names);
    }
    form.count("number", pin.number, 0, most_yarn);
}
template <class Form, Either<ForceField> M>
void describe(Form& form, M& field) {
    form.row("centre_mm", field.centre_mm, "must be three numbers from -1e9 to 1e9, in mm", Numbers{-1e9, 1e9});
    form.number("radius_mm", field.radius_mm, {1e-6, 1e6});
    form.number("strength_N_per_mm", field.strength_N_per_mm, {-1e9, 1e9});
}
template <class Form, Either<Flip> M>
void describe(Form& form, M& flip) {
    form.count("pick", flip.pick, 0, most_yarn);
    form.count("end", flip.end, 0, most_yarn);
    form.flag("weft_over", flip.weft_over);
}
template <class Form, Either<Parameters> M>
void describe(Form& form, M& parameters) {
    form.part("warp", parameters.warp);
    form.part("weft", parameters.weft);
    if constexpr (Form::reads) {
        if (parameters.warp == SystemScene{} && parameters.weft == SystemScene{}) form.reader().fail("changes nothing");
    }
}
template <class Form, Either<sim::SimulationRequest> M>
void describe(Form& form, M& plan) {
    form.word("fidelity", plan.fidelity, fidelity_names);
    form.maybe("region", plan.region, [](auto& inner, auto& region) { inner.part("region", region); });
    form.maybe("weft_mode", plan.weft_mode, [](auto& inner, auto& mode) { inner.word("weft_mode", mode, weft_mode_names); });
    maybe_number(form, "points_per_key", plan.points_per_key, {1, 1024});
    maybe_number(form, "sample_spacing", plan.sample_spacing, {1e-3, 1});
    form.flag("reduce", plan.reduce);
    form.list("held", plan.held, most_changes, "must be a pair of a pick and an end, in a list of at most 65536", Crossings{});
    form.row("relaxing_N_per_mm", plan.relaxing_N_per_mm, "must be two, each a number from -1e9 to 1e9 or null", RimForces{});
}
template <class Form, Either<Simulation> M>
void describe(Form& form, M& simulation) {
    form.part("plan", simulation.plan);
    form.word("solver", simulation.solver, solver_names);
    maybe_number(form, "residual", simulation.residual, {sim::least_residual, sim::most_residual});
    maybe_count(form, "most_steps", simulation.most_steps);
    maybe_number(form, "most_seconds", simulation.most_seconds, {0, most_seconds_told});
    form.maybe("start_from", simulation.start_from,
               [](auto& inner, auto& fidelity) { inner.word("start_from", fidelity, fidelity_names); });
}

/// Reads the alternative of a change whose member is there.
inline void read_change(Reading& form, Change& change) {
    const auto there = [&](const char* key) { return form.reader().has(key) ? 1 : 0; };
    if (there("parameters") + there("pins") + there("fields") + there("flip") != 1)
        return form.reader().fail("is one of parameters, pins, fields and flip", "change");
    if (there("parameters") == 1) form.part("parameters", change.emplace<Parameters>());
    if (there("pins") == 1) form.parts("pins", change.emplace<Pins>().pins, most_changes);
    if (there("fields") == 1) form.parts("fields", change.emplace<Fields>().fields, most_changes);
    if (there("flip") == 1) form.part("flip", change.emplace<Flip>());
}
inline void write_change(Writing& form, const Change& change) {
    if (const auto* parameters = std::get_if<Parameters>(&change)) form.part("parameters", *parameters);
    if (const auto* pins = std::get_if<Pins>(&change)) form.parts("pins", pins->pins, most_changes);
    if (const auto* fields = std::get_if<Fields>(&change)) form.parts("fields", fields->fields, most_changes);
    if (const auto* flip = std::get_if<Flip>(&change)) form.part("flip", *flip);
}
template <class Form, Either<Change> M>
void describe(Form& form, M& change) {
    if constexpr (Form::reads) read_change(form, change);
    else write_change(form, change);
}

// ---- From a client ----

template <class Form, Either<Hello> M>
void describe(Form& form, M& hello) {
    form.list("versions", hello.versions, most_versions, "must be a whole number from 1 on, in a list of at most 64", Counts{1, most_number});
    form.text("client", hello.client, longest_name);
}
template <class Form, Either<Create> M>
void describe(Form& form, M& create) {
    form.request(create.request);
    form.text("document", create.document, most_client_bytes);
    form.part("simulation", create.simulation);
}
template <class Form, Either<Attach> M>
void describe(Form& form, M& attach) {
    ask(form, attach);
    form.count("seq", attach.seq);
    form.count("frame", attach.frame);
}
template <class Form, class M>
    requires Either<M, Run> || Either<M, Pause> || Either<M, ReadState> || Either<M, Checkpoint> || Either<M, Close>
void describe(Form& form, M& message) {
    ask(form, message);
}
template <class Form, Either<Step> M>
void describe(Form& form, M& step) {
    ask(form, step);
    form.count("steps", step.steps, 1);
}
template <class Form, Either<MakeChange> M>
void describe(Form& form, M& make) {
    ask(form, make);
    describe(form, make.change);
}
template <class Form, Either<Acknowledge> M>
void describe(Form& form, M& acknowledge) {
    event(form, acknowledge);
}
template <class Form, Either<WantFrames> M>
void describe(Form& form, M& want) {
    ask(form, want);
    form.number("most_per_second", want.most_per_second, {0, 1000});
}
template <class Form, Either<Submit> M>
void describe(Form& form, M& submit) {
    form.request(submit.request);
    form.text("document", submit.document, most_client_bytes);
    form.part("simulation", submit.simulation);
    form.parts("flips", submit.flips, most_changes);
}
template <class Form, class M>
    requires Either<M, ListJobs> || Either<M, ListSessions>
void describe(Form& form, M& list) {
    form.request(list.request);
}
template <class Form, Either<Cancel> M>
void describe(Form& form, M& cancel) {
    form.request(cancel.request);
    form.count("job", cancel.job, 1);
}
template <class Form, Either<AcknowledgeJob> M>
void describe(Form& form, M& acknowledge) {
    form.count("job", acknowledge.job, 1);
}

// ---- From the server ----

template <class Form, Either<Welcome> M>
void describe(Form& form, M& welcome) {
    form.count("version", welcome.version, 1);
    form.text("server", welcome.server, longest_name);
    form.maybe("person", welcome.person, [](auto& inner, auto& person) { inner.text("person", person, longest_name); });
}
template <class Form, Either<Unsupported> M>
void describe(Form& form, M& unsupported) {
    form.list("versions", unsupported.versions, most_versions, "must be a whole number from 1 on, in a list of at most 64",
              Counts{1, most_number});
}
template <class Form, Either<Accepted> M>
void describe(Form& form, M& accepted) {
    form.request(accepted.request);
    maybe_count(form, "session", accepted.session, 1);
    maybe_count(form, "job", accepted.job, 1);
    maybe_number(form, "wait_s", accepted.wait_s, {0, most_seconds_told});
}
template <class Form, Either<Refused> M>
void describe(Form& form, M& refused) {
    maybe_request(form, refused.request);
    form.part("error", refused.error);
    maybe_number(form, "wait_s", refused.wait_s, {0, most_seconds_told});
}
template <class Form, Either<State> M>
void describe(Form& form, M& state) {
    ask(form, state);
    form.word("phase", state.phase, phase_names);
    form.count("step", state.step);
    form.count("seq", state.seq);
    form.count("frame", state.frame);
    form.count("layout", state.layout, 0, 0xffffffff);
    form.number("residual", state.residual, amount_range);
    maybe_count(form, "lost_crossings", state.lost_crossings);
}
template <class Form, Either<JobState> M>
void describe(Form& form, M& job) {
    form.count("job", job.job, 1);
    form.word("phase", job.phase, job_phase_names);
    form.text("title", job.title, longest_title);
    form.count("step", job.step);
    maybe_number(form, "residual", job.residual, amount_range);
    maybe_count(form, "lost_crossings", job.lost_crossings);
    maybe_number(form, "left_s", job.left_s, {0, most_seconds_told});
    maybe_count(form, "place", job.place, 1);
    maybe_number(form, "wait_s", job.wait_s, {0, most_seconds_told});
    form.maybe("batch", job.batch, [](auto& inner, auto& where) { inner.text("batch", where, longest_title); });
}
template <class Form, Either<JobList> M>
void describe(Form& form, M& list) {
    form.request(list.request);
    form.parts("jobs", list.jobs, most_jobs);
    form.flag("signs", list.signs);
}
template <class Form, Either<SessionSummary> M>
void describe(Form& form, M& session) {
    form.count("session", session.session, 1);
    form.text("title", session.title, longest_title);
    form.word("phase", session.phase, phase_names);
    form.count("step", session.step);
    maybe_number(form, "residual", session.residual, amount_range);
    form.count("points", session.points, 1, most_points);
    form.count("attached", session.attached);
    form.flag("ended", session.ended);
    maybe_number(form, "left_s", session.left_s, {0, most_seconds_told});
}
template <class Form, Either<SessionList> M>
void describe(Form& form, M& list) {
    form.request(list.request);
    form.parts("sessions", list.sessions, most_sessions);
}
template <class Form, Either<JobProgress> M>
void describe(Form& form, M& progress) {
    describe(form, progress.state);
}
template <class Form, Either<JobEnded> M>
void describe(Form& form, M& ended) {
    form.count("job", ended.job, 1);
    form.word("phase", ended.phase, job_phase_names);
    if constexpr (Form::reads) {
        if (ended.phase < JobPhase::done) form.reader().fail("is no end of a job", "phase");
    }
    maybe_error(form, ended.error);
    form.object("report", ended.report);
    form.maybe("evidence", ended.evidence, [](auto& inner, auto& evidence) { inner.object("evidence", evidence); });
}
template <class Form, Either<Gap> M>
void describe(Form& form, M& gap) {
    form.count("session", gap.session, 1);
    form.count("first", gap.first, 1);
    form.count("last", gap.last, 1);
    if constexpr (Form::reads) {
        if (gap.last < gap.first) form.reader().fail("is before the first", "last");
    }
}

// ---- Events ----

template <class Form, Either<LayoutYarn> M>
void describe(Form& form, M& yarn) {
    form.word("system", yarn.system, system_names);
    form.count("number", yarn.number, 0, most_yarn);
    form.count("beam", yarn.beam, 0, most_yarn);
    form.number("radius_mm", yarn.radius_mm, {1e-9, 1e9});
    form.colour("colour", yarn.colour);
    form.count("points", yarn.points, 1, most_points);
    form.flag("periodic", yarn.is_periodic);
    form.row("turns", yarn.turns, "must be two whole numbers from 0 to 1000", Counts{0, 1000});
}
template <class Form, Either<Layout> M>
void describe(Form& form, M& layout) {
    event(form, layout);
    form.count("layout", layout.layout, 1, 0xffffffff);
    form.word("fidelity", layout.fidelity, fidelity_names);
    form.row("periodic", layout.is_periodic, "must be two, each true or false", Flags{});
    form.row("repeats", layout.repeats, "must be two whole numbers from 1 on", Counts{1, most_number});
    form.parts("yarns", layout.yarns, most_yarns);
}
template <class Form, Either<PhaseChanged> M>
void describe(Form& form, M& changed) {
    event_at_step(form, changed);
    form.word("phase", changed.phase, phase_names);
}
template <class Form, Either<Applied> M>
void describe(Form& form, M& applied) {
    event_at_step(form, applied);
    form.request(applied.request);
    describe(form, applied.change);
    maybe_error(form, applied.error);
}
template <class Form, Either<Flipped> M>
void describe(Form& form, M& flipped) {
    event_at_step(form, flipped);
    form.request(flipped.request);
    form.flag("done", flipped.done);
    form.text("reason", flipped.reason, longest_words);
}
template <class Form, Either<Checkpointed> M>
void describe(Form& form, M& checkpointed) {
    event_at_step(form, checkpointed);
    maybe_request(form, checkpointed.request);
}
template <class Form, Either<Recovered> M>
void describe(Form& form, M& recovered) {
    event_at_step(form, recovered);
    form.count("frame", recovered.frame);
}
template <class Form, Either<Ended> M>
void describe(Form& form, M& ended) {
    event_at_step(form, ended);
    form.word("why", ended.why, why_names);
    maybe_error(form, ended.error);
    form.object("report", ended.report);
}

}  // namespace weave::wire::form
