#pragma once

#include <loomlink/keys/release_index.hpp>
#include <loomlink/keys/release_manifest.hpp>
#include <loomlink/workflow/cloths.hpp>
#include <loomlink/workflow/desk.hpp>
#include <loomlink/workflow/found.hpp>
#include <loomlink/workflow/trust_chain.hpp>
#include <optional>
#include <string>
#include <vector>

namespace weave::loomlink {

/// What is to be released where.
struct ReleaseWish {
    std::string design;
    std::int64_t revision = 0;
    std::string loom;
    std::vector<std::int64_t> feeders;       ///< the loom's, from 1, of each feeder of the design
    std::optional<std::int64_t> supersedes;  ///< the release of this design that the loom has now
    std::string reason;
};

/// Releases: files for one loom, made and proved by the server, signed by people.
class ReleaseDesk {
  public:
    ReleaseDesk(Desk& desk, ClothShelf& shelf) : m_desk(&desk), m_shelf(&shelf) {}

    /// Validates again, makes the files, reads them back, and takes the first signature: `loom`, `number`,
    /// `state` (`awaiting` until as many people signed as have to).
    Result<Json> release(const Caller& caller, const Ask& ask, const ReleaseWish& wish);
    Result<Json> sign(const Caller& caller, const Ask& ask, const std::string& loom, std::int64_t number,
                      const std::string& reason);
    /// Recalls it: no terminal takes it any more.
    Result<Json> withdraw(const Caller& caller, const Ask& ask, const std::string& loom, std::int64_t number,
                          const std::string& reason);

    /// The answer about a release. The look is logged.
    Result<Json> read(const Caller& caller, const std::string& loom, std::int64_t number);
    /// Bytes of the signed manifest, or of a file, of a release that may be woven now; refused otherwise. The
    /// pull is logged.
    Result<std::string> manifest(const Caller& caller, const std::string& loom, std::int64_t number);
    Result<std::string> file(const Caller& caller, const std::string& loom, std::int64_t number,
                             const std::string& name);
    Result<std::string> card(const Caller& caller, const std::string& loom, std::int64_t number,
                             const CardTile& tile);
    /// `picks` from this one (from 1) on, at most 1,000.
    Result<Json> picks(const Caller& caller, const std::string& loom, std::int64_t number, std::int64_t from,
                       std::int64_t count);

    /// `index` (the signed bytes as text), `trust` (documents from `trust_from` on), and where `head_from` is
    /// not 0 `consistency`: that the log goes on from its first so many records. Stamped for the policy's
    /// hours.
    Result<Json> index(const Caller& caller, const std::string& loom, std::int64_t trust_from,
                       std::uint64_t head_from);

  private:
    struct ProvenRelease;
    Result<Json> store_release(const Caller& caller, const Ask& ask, const Deed& deed,
                               const ReleaseWish& wish, const ProvenRelease& proven);
    Result<RevisionClothPtr> cloth_of(const Caller& caller, const std::string& loom, std::int64_t number);

    Desk* m_desk;
    ClothShelf* m_shelf;
};

/// The signed manifest as it is handed out: with the signatures that count by the newest trust document.
struct SignedManifest {
    std::string bytes;
    std::size_t people = 0, needed = 0;  ///< who signed with a key that counts, and how many must
    std::size_t counting = 0;            ///< signatures of keys that count
};
Result<SignedManifest> signed_manifest(const Reader& reader, const Release& release);

/// `released`, `awaiting`, `superseded` or `withdrawn`.
const char* release_word(ReleaseStage state);

/// The word for what a release is now: `awaiting` as well where it is in force but too few of the keys that
/// signed it count, since a key was revoked or more people must sign than then. Nobody can pull it then.
Result<std::string> state_now(const Reader& reader, const Release& release);

/// Why a release came to its last state, and when.
struct LastStep {
    std::string reason, at, by;
};
Result<LastStep> last_step(const Reader& reader, const Release& release);

/// The newest head of the log; signed anew where the log has grown since.
Result<SignedTreeHead> current_head(Desk& desk);

}  // namespace weave::loomlink
