#include <loomlink/commands/evidence_file.hpp>

#include <weave/core/file.hpp>
#include <weave/core/text.hpp>

#include <utility>

namespace weave::loomlink {

std::string EvidenceToFile::words() const {
    return "a simulation at " + on_one_line(statement.fidelity) +
           (statement.converged ? ", at rest" : ", NOT at rest") +
           (statement.order_kept ? "" : ", crossings changed");
}

Result<EvidenceToFile> evidence_from(std::string_view bytes) {
    WEAVE_TRY(wire::SignedEvidence evidence, wire::read_evidence(bytes));
    WEAVE_TRY(wire::SimulationStatement statement, wire::read_simulation(evidence.statement));
    return EvidenceToFile{std::move(evidence), std::move(statement)};
}

Result<EvidenceToFile> load_evidence(const std::string& file) {
    WEAVE_TRY(const std::string bytes, read_file(file, wire::most_evidence));
    auto evidence = evidence_from(bytes);
    if (!evidence) return std::move(evidence).error().in(file);
    return evidence;
}

}  // namespace weave::loomlink
