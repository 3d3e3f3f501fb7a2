#include <studio/panels/rule_fixes.hpp>

#include <QCoreApplication>

#include <map>

namespace weave::studio {

namespace {

struct Fixes {
    Q_DECLARE_TR_FUNCTIONS(weave::studio::Fixes)
  public:
    static std::map<std::string, QString> all() {
        return {
            {"block.constraints", tr("Draw the block again, or undo the last change: a stack must hold each of its picks and ends once.")},
            {"flips.apply", tr("The block below this flip has changed. Undo that change, or flip the crossing again where it now can be.")},
            {"float.face", tr("Flip a crossing in the middle of the float, so that a yarn of the other system binds it.")},
            {"float.back", tr("Flip a crossing in the middle of the float on the back, best one that the face covers.")},
            {"bind.pick", tr("Flip one of its crossings, so that it goes over one end and under another; or draw it as loose on purpose.")},
            {"bind.end", tr("Flip one of its crossings, so that it goes over one pick and under another; or draw it as loose on purpose.")},
            {"hooks.fit", tr("Make the cloth narrower, or choose a loom with more hooks.")},
            {"hooks.castout", tr("Choose another loom profile, or have its list of cast-out hooks corrected.")},
            {"hooks.shared", tr("On this harness these ends move together. Weave them alike, or choose a loom without repeats.")},
            {"hooks.read-back", tr("Do not weave this. Tell who keeps the loom profile: the controller's file does not give the card again.")},
            {"picks.limit", tr("Shorten the design, or weave it as several files.")},
            {"name.limit", tr("Shorten the title, or accept that the loom shows its beginning.")},
            {"feeders.per-pick", tr("Give the pick fewer feeders in the weft plan.")},
            {"feeders.none", tr("Give the pick a feeder, or take out what would bind it.")},
            {"feeders.range", tr("Use fewer feeders in the weft plan, or choose a loom with more.")},
            {"lift.balance", tr("Spread the lifted ends over neighbouring picks, or renumber the picks of the stack.")},
            {"lift.share", tr("Weave the cloth face down, or flip crossings of this pick to the weft's side.")},
            {"lift.face-down", tr("If the loom labours, weave the cloth face down.")},
            {"insertion.match", tr("Choose in the simulation's scene how this loom inserts the weft, or choose another loom.")},
            {"selvedge.needed", tr("Choose a loom profile with selvedge hooks, or have some added.")},
            {"selvedge.binds", tr("Have the selvedge weave of the loom profile corrected.")},
            {"turn.caught", tr("Flip the crossing of the last end with this pick, so that the end catches the turning weft.")},
            {"turn.crossed", tr("Renumber the two picks, or flip the end that catches them.")},
            {"turn.box", tr("Add or remove a pick of this feeder, so that its shuttle comes back to where the next one starts.")},
            {"turn.cut", tr("Choose the shuttle as insertion, or let the picks run from edge to edge.")},
            {"repeat.doubled", tr("Nothing has to be done; with an even number of picks a feeder the repeat would go on without a break.")},
            {"take-up.stop", tr("Leave the take-up of the weft plan to the program, or stop it between the picks of a row.")},
            {"take-up.regulator", tr("Choose a loom with a hook for the take-up, or weave one pick a row.")},
            {"take-up.beam", tr("Put the ends that take up less or more on a beam of their own.")},
            {"reed.width", tr("Weave fewer ends or closer ones, or choose a wider loom.")},
            {"reed.dents", tr("Nothing has to be done; add ends to fill the last dent if it shows.")},
            {"warp.density", tr("Set the density of the warp to that of the harness, or choose another loom.")},
            {"cloth.width", tr("For your information: plan the width in the reed with it.")},
            {"consumption", tr("For your information: order yarn with it.")},
        };
    }
};

}  // namespace

QString fix_for(const std::string& rule) {
    static const std::map<std::string, QString> fixes = Fixes::all();
    const auto found = fixes.find(rule);
    return found == fixes.end() ? QString() : found->second;
}

}  // namespace weave::studio
