#include <weave/command/command_outcome.hpp>

#include <weave/core/exit_code.hpp>
#include <weave/core/text.hpp>

#include <iostream>
#include <utility>

namespace weave {

CommandOutcome::CommandOutcome(std::string program, JsonLayout layout)
    : m_program(std::move(program)), m_layout(layout) {}

void CommandOutcome::fail(const Error& error) {
    exit_code = exit_code_of(error.code);
    note(error.text());
    if (json && !m_answered) answer({{"error", error_json(error)}}, "");
}

void CommandOutcome::note(const std::string& line) const {
    std::cerr << m_program + ": " + on_one_line(line) + '\n';  // one write: mpirun puts lines of its own between any two
}

void CommandOutcome::answer(const Json& json_answer, const std::string& words) {
    m_answered = true;
    const int indent = m_layout == JsonLayout::over_lines ? 1 : -1;
    if (json)  // in ASCII: a terminal obeys some characters beyond it
        std::cout << json_answer.dump(indent, ' ', true, Json::error_handler_t::replace) << '\n';
    else
        std::cout << words;
    std::cout.flush();
}

}  // namespace weave
