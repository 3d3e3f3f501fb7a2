#include <loomlink/workflow/rules.hpp>

#include <algorithm>
#include <array>
#include <loomlink/workflow/denial.hpp>

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

/// What the action means to people.
std::string in_words(Action action) {
    std::string text = word(action);
    std::replace(text.begin(), text.end(), '-', ' ');
    return text;
}

/// Why a state does not allow an action, and what can be done, behind `revision 3 `.
const char* hindrance(RevisionState state, Action action) {
    switch (state) {
        case RevisionState::draft:
            return action == Action::release ? "was not submitted and approved yet"
                                             : "was not submitted yet: a designer submits it first";
        case RevisionState::submitted:
            return action == Action::submit ? "waits for approval already"
                                            : "waits for approval still: it has to be approved first";
        case RevisionState::changes_requested:
            return "had changes requested: they are saved as a new revision, and that is submitted";
        case RevisionState::approved:
            return action == Action::request_changes
                       ? "is approved already: comment on it, and have the changes saved as a new revision"
                       : "is approved already: it can be released";
        case RevisionState::released:
            return action == Action::request_changes
                       ? "is released already: withdraw the release, or have the changes saved as a new "
                         "revision"
                       : "is released already";
        case RevisionState::superseded:
            return "was superseded by a later release: work goes on in a new revision";
        case RevisionState::withdrawn:
            return "was withdrawn from its looms: work goes on in a new revision";
    }
    return "is in no known state";
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
        return deny(Denial::rights, "your roles do not let you " + in_words(action));
    if (is_judgement(action) && is_author(caller, revision))
        return deny(Denial::rights, "you are an author of this revision: somebody else has to decide on it");
    if (!state_allows(revision.state, action))
        return deny(Denial::conflict,
                    "revision " + std::to_string(revision.number) + " " + hindrance(revision.state, action));
    return {};
}

std::vector<std::string> allowed_actions(const Caller& caller, const Revision& revision) {
    std::vector<std::string> words;
    for (const Action action : all_actions)
        if (may(caller, action, revision)) words.emplace_back(word(action));
    return words;
}

}  // namespace weave::loomlink
