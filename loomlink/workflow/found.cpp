#include <loomlink/workflow/found.hpp>

#include <algorithm>

namespace weave::loomlink {

namespace {

bool names(const std::vector<Loom>& looms, const std::string& name) {
    return std::any_of(looms.begin(), looms.end(), [&](const Loom& loom) { return loom.name == name; });
}

Result<Loom> loom_named(const Reader& reader, const std::string& name) {
    WEAVE_TRY(auto loom, reader.loom(name));
    if (!loom) return deny(Denial::absent, "there is no such loom");
    return *std::move(loom);
}

}  // namespace

Status need_designs_open(const Caller& caller) {
    if (caller.reads_designs()) return {};
    return deny(Denial::rights, "designs are not open to you");
}

Result<Design> find_design(const Reader& reader, const Caller& caller, const std::string& design) {
    WEAVE_CHECK_OK(need_designs_open(caller));
    WEAVE_TRY(auto found, reader.design(design));
    if (!found) return deny(Denial::absent, "there is no such design");
    return *std::move(found);
}

Result<FoundRevision> find_revision(const Reader& reader, const Caller& caller, const std::string& design,
                                    std::int64_t number) {
    WEAVE_TRY(Design found, find_design(reader, caller, design));
    WEAVE_TRY(auto revision, reader.revision(found.id, number));
    if (!revision) return deny(Denial::absent, "the design has no such revision");
    return FoundRevision{std::move(found), *std::move(revision)};
}

Status check_on_card(const Revision& revision, std::optional<std::int64_t> pick, std::optional<std::int64_t> end) {
    const auto check = [](const char* what, std::optional<std::int64_t> place, std::int64_t most) -> Status {
        if (!place || (*place >= 1 && *place <= most)) return {};
        return bad_input("the card has " + std::string(what) + "s 1 to " + std::to_string(most), what);
    };
    WEAVE_CHECK_OK(check("pick", pick, revision.picks));
    return check("end", end, revision.ends);
}

Result<Loom> find_loom(const Reader& reader, const Caller& caller, const std::string& loom) {
    if (!caller.reads_designs() && !caller.is(PersonRole::administrator)) {
        WEAVE_TRY(const auto own, reader.looms_of(caller.id));
        if (!caller.is(PersonRole::operator_) || !names(own, loom))
            return deny(Denial::absent, "there is no such loom");
    }
    return loom_named(reader, loom);
}

Result<Loom> find_own_loom(const Reader& reader, const Caller& caller, const std::string& loom) {
    if (!caller.is(PersonRole::operator_)) return deny(Denial::rights, "this takes the role operator");
    WEAVE_TRY(const auto own, reader.looms_of(caller.id));
    if (!names(own, loom)) return deny(Denial::rights, "you are no operator of this loom");
    return loom_named(reader, loom);
}

Result<FoundRelease> find_release(const Reader& reader, const Caller& caller, const std::string& loom,
                                  std::int64_t number) {
    WEAVE_TRY(Loom found, find_loom(reader, caller, loom));
    WEAVE_TRY(const auto own, reader.looms_of(caller.id));
    if (!caller.reads_designs() && !(caller.is(PersonRole::operator_) && names(own, loom)))
        return deny(Denial::rights, "releases are not open to you");
    WEAVE_TRY(auto releases, reader.releases(found.id));
    for (Release& release : releases)
        if (release.number == number) return FoundRelease{std::move(found), std::move(release)};
    return deny(Denial::absent, "the loom has no such release");
}

Result<std::string> full_name_of(const Reader& reader, Id person) {
    WEAVE_TRY(const auto found, reader.person(person));
    return found ? found->full_name : std::string("nobody");
}

}  // namespace weave::loomlink
