#pragma once

#include <weave/core/json.hpp>
#include <weave/keys/hash.hpp>

#include <compare>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace weave::loomlink {

/// Numbers of rows. 0 is none.
using Id = std::int64_t;
/// The number of a record of the log.
using Seq = std::uint64_t;

/// Moments are UTC text as in a Statement; `event` is the record of the log that tells of the thing.

enum class PersonRole : std::uint8_t { designer, approver, operator_, engineer, administrator };

struct Person {
    Id id = 0;
    std::string login;
    std::string full_name;
    bool active = true;
    std::string password;  ///< its hash, opaque here
    std::vector<PersonRole> roles;
    Seq event = 0;
};

/// A public key, and its secret where the store keeps that sealed.
struct PersonKey {
    std::string id;            ///< 64 hexadecimal characters
    std::optional<Id> person;  ///< none: the log's, a machine's
    std::string purpose;       ///< such as `release`, `evidence`
    Hash public_key{};         ///< 32 bytes
    std::optional<std::string> sealed;
    Seq created = 0;
    std::optional<Seq> revoked;
};

struct Session {
    Hash token{};  ///< the hash of the token, never the token
    Id person = 0;
    std::string expires;
    std::string csrf;
};

struct Design {
    Id id = 0;
    std::string name;
    Seq event = 0;
};

struct Branch {
    Id design = 0;
    std::string name;
    Id head = 0;
    Seq event = 0;
};

enum class RevisionState : std::uint8_t {
    draft,
    submitted,
    approved,
    changes_requested,
    released,
    superseded,
    withdrawn,
};

/// One version of a design. `number`, `hash`, `authors`, `state` and `id` are given by the store.
struct Revision {
    Id id = 0;
    Hash hash{};
    Id design = 0;
    std::int64_t number = 0;  ///< from 1 within its design
    std::vector<Id> parents;  ///< none, one, or those of a merge
    Id author = 0;
    std::vector<Id> authors;  ///< of it, and of ancestors that nobody had approved
    std::string at;
    std::string message;
    Hash document{};  ///< an object
    Hash design_sha256{};
    Hash scene_sha256{};
    Hash card_sha256{};
    std::int64_t picks = 0;
    std::int64_t ends = 0;
    RevisionState state = RevisionState::draft;
    Seq event = 0;
};

enum class DecisionKind : std::uint8_t { approve, request_changes };

struct Decision {
    Id revision = 0;
    Id person = 0;
    DecisionKind kind = DecisionKind::approve;
    Seq event = 0;
};

/// A finding of the validation that somebody lets pass, and why.
struct Waiver {
    Id revision = 0;
    std::string rule;
    std::string reason;
    Id person = 0;
    Seq event = 0;
};

/// What a simulation found. It speaks of every revision with this very design and scene.
struct Evidence {
    Id id = 0;
    Hash design_sha256{};
    Hash scene_sha256{};
    double coverage = 0;  ///< share of the cloth, 0 to 1
    std::string fidelity;
    std::string parameters;  ///< JSON
    std::string solver;
    std::optional<double> residual;  ///< none where it was not finite
    bool converged = false;
    Hash report{};  ///< an object
    std::string signer;
    Seq event = 0;
};

struct Comment {
    Id revision = 0;
    Id person = 0;
    std::string text;
    Seq event = 0;
};

struct Loom {
    Id id = 0;
    std::string name;
    Seq event = 0;
};

struct LoomProfileVersion {
    Id loom = 0;
    std::int64_t version = 0;  ///< from 1
    Hash object{};
    Seq event = 0;
};

enum class ReleaseStage : std::uint8_t { prepared, released, superseded, withdrawn };

struct ReleaseFile {
    std::string name;
    Hash object{};
    std::int64_t size = 0;  ///< bytes; given by the store
};

struct ReleaseSignature {
    std::string key;
    std::string value;  ///< 128 hexadecimal characters
    Seq event = 0;
};

/// Files for one loom. `number`, `state`, `signatures` and `id` are given by the store.
struct Release {
    Id id = 0;
    Id loom = 0;
    std::int64_t number = 0;  ///< from 1 within its loom
    Id revision = 0;
    std::int64_t profile_version = 0;
    std::string feeders;  ///< JSON: which yarn of the design lies in which feeder
    Hash manifest{};      ///< an object
    std::vector<ReleaseFile> files;
    std::vector<ReleaseSignature> signatures;
    ReleaseStage state = ReleaseStage::prepared;
    Seq event = 0;
};

/// The last woven pick of a release.
struct Bookmark {
    Id release = 0;
    std::int64_t pick = 0;
    Id person = 0;
};

struct FaultReport {
    Id release = 0;
    std::optional<std::int64_t> pick;
    std::string text;
    Id person = 0;
    Seq event = 0;
};

struct Loaded {
    Id release = 0;
    Id person = 0;
    Seq event = 0;
};

/// A one-time code by which a person, or a machine that signs, joins.
struct Invitation {
    Hash code{};                      ///< the hash of the code, never the code
    std::string purpose;              ///< `person` or `signer`
    std::optional<std::string> name;  ///< who alone may use it
    std::string roles;                ///< words with commas between; opaque here
    std::string expires;
    Seq event = 0;
    std::optional<Seq> used;
};

/// A version of what the site agreed on, or of whose keys count.
struct SitePaper {
    std::int64_t number = 0;  ///< from 1
    std::string text;
    Seq event = 0;
};

/// A state that a revision or release came to, and the record that tells of it.
template <class State>
struct Step {
    State state{};
    Seq event = 0;
};

/// One thing that the tables keep beside log and objects: a person, a state of a revision, a signature.
struct KeptThing {
    std::string place;   ///< its name, by what people call things: `state of revision 2 of shoe by record 17`
    std::string values;  ///< all that is said of it, a JSON list
    friend auto operator<=>(const KeptThing&, const KeptThing&) = default;
};
/// Text in `values` that is no UTF-8 is written with replacements, so that damage can be told.
KeptThing kept_thing(std::string place, const Json& values);

/// The words of the enumerations as the store and the service write them.
const char* word(PersonRole role);
const char* word(RevisionState state);
const char* word(DecisionKind kind);
const char* word(ReleaseStage state);

}  // namespace weave::loomlink
