#include <loomlink/commands/trust_papers.hpp>

#include <weave/core/file.hpp>
#include <weave/wire/mill_session.hpp>

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

Result<TrustDocument> trust_from_file(const std::filesystem::path& file, const std::string& fingerprint) {
    WEAVE_TRY(const std::string told,
              wire::parse_fingerprint(fingerprint, "--fingerprint", "as an administrator reads them from loomlink trust show"));
    WEAVE_TRY(const std::string bytes, read_file(file, most_trust_bytes));
    auto trust = read_trust(bytes);
    if (!trust && trust.error().code == ErrorCode::refused)  // it is not what its people signed either
        return invalid(trust.error().message, trust.error().where).in(file.string());
    if (!trust) return std::move(trust).error().in(file.string());
    if (trust->fingerprint() == told) return trust;
    return invalid("has the fingerprint " + trust->fingerprint() + ", not the one that was given; ask an administrator", file.string());
}

}  // namespace weave::loomlink
