#pragma once

#include <loomlink/keys/trust.hpp>
#include <loomlink/workflow/desk.hpp>
#include <optional>
#include <string>

namespace weave::loomlink {

/// The newest trust document; nothing before the first one.
Result<std::optional<TrustDocument>> newest_trust(const Reader& reader);

/// Whose keys count at this site, as a chain of documents that administrators sign.
class TrustChain {
  public:
    explicit TrustChain(Desk& desk) : m_desk(&desk) {}

    /// `number`, `fingerprint`, `documents` from this number on, as signed (texts).
    Result<Json> documents(std::int64_t from);
    /// Signs the next document: administrators as roots, approvers as releasers, enrolled signers, the keys
    /// of the server; as many must sign a release as the policy says. With `keep_server_keys` the stamp and
    /// log keys of the document before go on counting beside the new ones. The first document needs an
    /// approver.
    Result<Json> publish(const Caller& caller, const Ask& ask, bool keep_server_keys);
    /// What the next document would change, in words; empty: nothing. For admins.
    Result<Json> pending(const Caller& caller);

  private:
    Result<Json> publish_next(const Caller& caller, const Ask& ask, Deed& deed, bool keep_server_keys);

    Desk* m_desk;
};

/// How a next trust document would differ from the newest in whose keys count, in words.
Result<std::vector<std::string>> trust_changes(const Reader& reader, const Desk& desk);

}  // namespace weave::loomlink
