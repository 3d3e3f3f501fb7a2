#include <algorithm>
#include <array>
#include <loomlink/workflow/denial.hpp>
#include <loomlink/workflow/rules.hpp>

namespace weave::loomlink {

namespace {

constexpr std::array all_actions{Action::submit, Action::comment, Action::request_changes,
                                 Action::waive,  Action::approve, Action::release};
constexpr std::array action_words{"submit", "comment", "request-changes", "waive", "approve", "release"};

bool role_allows(const Caller& caller, Action action) {
    switch (action) {
        case Action::submit:
            return caller.is(PersonRole::designer);
        case Action::comment:
            return caller.is(PersonRole::designer) || caller.is(PersonRole::approver);
        case Action::request_changes:
        case Action::waive:
        case Action::approve:
        case Action::release:
            return caller.is(PersonRole::approver);
    }
    return false;
}

bool state_allows(RevisionState state, Action action) {
    switch (action) {
        case Action::submit:
            return state == RevisionState::draft;
        case Action::comment:
            return true;
        case Action::request_changes:
        case Action::approve:
            return state == RevisionState::submitted;
        // A release is validated anew, so what that finds may have to be waived after the approval.
        case Action::waive:
            return state == RevisionState::submitted || state == RevisionState::approved ||
                   state == RevisionState::released;
        case Action::release:
            return state == RevisionState::approved || state == RevisionState::released;
    }
    return false;
}

/// What nobody decides about own work.
bool is_judgement(Action action) {
    return action == Action::waive || action == Action::approve;
}

}  // namespace

const char* word(Action action) {
    return action_words[static_cast<std::size_t>(action)];
}

bool is_author(const Caller& caller, const Revision& revision) {
    return std::find(revision.authors.begin(), revision.authors.end(), caller.id) != revision.authors.end();
}

Status may(const Caller& caller, Action action, const Revision& revision) {
    if (!caller.reads_designs()) return deny(Denial::rights, "designs are not open to you");
    if (!role_allows(caller, action))
        return deny(Denial::rights, std::string("your roles do not let you ") + word(action));
    if (is_judgement(action) && is_author(caller, revision))
        return deny(Denial::rights, "you are an author of this revision: somebody else has to decide on it");
    if (!state_allows(revision.state, action))
        return deny(Denial::conflict,
                    std::string("the revision is ") + word(revision.state) + ": no time to " + word(action));
    return {};
}

std::vector<std::string> allowed_actions(const Caller& caller, const Revision& revision) {
    std::vector<std::string> words;
    for (const Action action : all_actions)
        if (may(caller, action, revision)) words.emplace_back(word(action));
    return words;
}

}  // namespace weave::loomlink
