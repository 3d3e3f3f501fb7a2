#include <loomlink/commands/trust_papers.hpp>

namespace weave::loomlink {

Result<std::vector<std::string>> trust_papers(wire::MillClient& client) {
    WEAVE_TRY(const Json answer, client.get("/trust"));
    return wire::texts_member(answer, "documents");
}

Result<TrustDocument> newest_trust_of(wire::MillClient& client) {
    WEAVE_TRY(const auto papers, trust_papers(client));
    if (papers.empty()) return Error{ErrorCode::refused, "nobody has signed a trust document yet", "trust"};
    return read_trust(papers.back());
}

}  // namespace weave::loomlink
