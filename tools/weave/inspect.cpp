// Looking relaxed cloth over, and comparing it with what was measured.

#include "command.hpp"

#include <weave/core/text.hpp>
#include <weave/sim/inspect.hpp>

#include <memory>

namespace weave::program {

namespace {

bool is_at_rest(const Yarns& yarns) {
    const auto found = yarns.report.find("converged");
    return found != yarns.report.end() && found->is_boolean() && found->get<bool>();
}

Status run_inspection(Program& program, const std::string& file) {
    WEAVE_TRY(const Yarns yarns, load_yarns(file));
    Result<Inspection> inspection = inspect(yarns);
    if (!inspection) return std::move(inspection).error().in(file);
    program.answer(inspection_json(yarns, *inspection), inspection_text(yarns, *inspection));
    if (!is_at_rest(yarns) || !inspection->changed.empty() || !inspection->leaning.empty())
        program.exit_code = findings;
    return {};
}

void add_inspect(CLI::App& app, Program& program) {
    CLI::App* command = add_command(
        app, program, "inspect",
        "Look relaxed cloth over: take-up, crimp, thickness, what leans, bunches, jams or has moved "
        "(exit 1: not at rest, a crossing changed, or a layer leans)");
    const auto file = std::make_shared<std::string>();
    command->add_option("FILE", *file, "the .yarns file of `weave simulate`")->required();
    on_run(command, program, [=, &program] { return run_inspection(program, *file); });
}

}  // namespace

void add_inspection_commands(CLI::App& app, Program& program) {
    add_inspect(app, program);
}

}  // namespace weave::program
