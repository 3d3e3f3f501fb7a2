#include <loomlink/service/deeds.hpp>

#include <map>

namespace weave::loomlink {

namespace {

const std::map<std::string, std::string>& deeds() {
    static const std::map<std::string, std::string> of_route{
        {"login", "person.signed_in"},
        {"logout", "person.signed_out"},
        {"me.password", "person.password_changed"},
        {"access.token", "access.given"},
        {"invitation.make", "person.invited"},
        {"invitation.accept", "person.joined"},
        {"person.roles", "person.roles_set"},
        {"person.disable", "person.disabled"},
        {"person.enable", "person.enabled"},
        {"signer.invite", "signer.invited"},
        {"signer.enrol", "signer.enrolled"},
        {"signer.revoke", "signer.revoked"},
        {"trust.extend", "trust.published"},
        {"design", "design.viewed"},
        {"design.make", "design.added"},
        {"revision", "revision.viewed"},
        {"revision.save", "revision.saved"},
        {"revision.document", "revision.viewed"},
        {"revision.picture", "revision.viewed"},
        {"revision.card", "revision.viewed"},
        {"revision.check", "revision.checked"},
        {"revision.submit", "revision.submitted"},
        {"revision.comment", "revision.commented"},
        {"revision.request-changes", "revision.changes_requested"},
        {"revision.waive", "revision.waived"},
        {"revision.approve", "revision.approved"},
        {"revision.evidence", "evidence.added"},
        {"revision.bundle", "revision.exported"},
        {"diff", "revision.viewed"},
        {"diff.picture", "revision.viewed"},
        {"release", "release.viewed"},
        {"release.make", "release.made"},
        {"release.sign", "release.signed"},
        {"release.withdraw", "release.withdrawn"},
        {"release.manifest", "release.pulled"},
        {"release.file", "release.pulled"},
        {"release.card", "release.viewed"},
        {"release.picks", "release.viewed"},
        {"loom", "loom.viewed"},
        {"loom.make", "loom.added"},
        {"loom.profile", "loom.profile_set"},
        {"loom.operators", "loom.operators_set"},
        {"loom.index", "loom.index_pulled"},
        {"loom.watch", "loom.watched"},
        {"loom.place", "loom.place_kept"},
        {"loom.fault", "loom.fault_reported"},
        {"loom.faults", "loom.viewed"},
        {"events", "log.viewed"},
        {"audit.bundle", "log.exported"},
    };
    return of_route;
}

}  // namespace

std::string deed_of_route(const std::string& route) {
    const auto found = deeds().find(route);
    return found == deeds().end() ? route : found->second;
}

}  // namespace weave::loomlink
