#include <weave/loom/check.hpp>

namespace weave {

const std::vector<Rule>& rules() {
    using enum Severity;
    static const std::vector<Rule> all{
        {"block.constraints", error,
         "every stack holds each pick of its row and each end of its column exactly once"},
        {"flips.apply", error, "every flip of the design still applies"},
        {"float.face", warning, "no yarn passes more stacks on the face at a stretch than the loom's limit"},
        {"float.back", warning, "no yarn passes more stacks on the back at a stretch than the loom's limit"},
        {"bind.pick", error,
         "every pick that is not loose on purpose passes over one end and under another in a repeat"},
        {"bind.end", error,
         "every end that is not loose on purpose passes over one pick and under another in a repeat"},
        {"hooks.fit", error, "the loom has a hook for every end"},
        {"hooks.castout", error,
         "cast-out hooks, and hooks that serve something else, carry no end and never lift"},
        {"hooks.shared", error, "ends that share a hook are lifted on the same picks"},
        {"hooks.read-back", error, "the controller's file, read back, gives the card image again"},
        {"picks.limit", error, "the design has no more picks than one file holds"},
        {"name.limit", info, "the title fits the name field of the file"},
        {"feeders.per-pick", error, "no pick takes more feeders than the loom can present at once"},
        {"feeders.none", error, "a pick without weft only takes up"},
        {"feeders.range", error, "the loom has every feeder that the picks ask for"},
        {"lift.balance", warning, "the share of lifted ends does not change too much from pick to pick"},
        {"lift.share", warning, "no pick lifts too large a share of the ends"},
        {"lift.face-down", info, "whether the loom would lift less with the face of the cloth down"},
        {"insertion.match", warning, "the loom inserts the weft as the design was drawn for"},
        {"selvedge.needed", warning, "a loom that cuts each pick has hooks for a selvedge"},
        {"selvedge.binds", error,
         "every selvedge end binds, and on both sides the selvedge holds every pick"},
        {"turn.caught", error,
         "every turn of a shuttle's weft, at the repeat as well, is caught by a pick or by an end that is "
         "not "
         "trimmed"},
        {"turn.crossed", error, "the two turns of a pick do not pull past each other"},
        {"turn.box", error,
         "the shuttle stands on the side where its next pick starts, at the repeat as well"},
        {"turn.cut", warning, "a design whose weft turns in the cloth is woven with a shuttle"},
        {"repeat.doubled", info,
         "each feeder's picks come out even, so that the repeat continues in the same direction"},
        {"take-up.stop", error,
         "the cloth stands still between the picks of one row and advances after the last"},
        {"take-up.regulator", info, "the loom has a hook that stops the take-up where the design needs it"},
        {"take-up.beam", warning, "the ends of one beam take up alike"},
        {"reed.width", error, "the warp with its selvedge is not wider than the reed"},
        {"reed.dents", info, "the ends of all repeats fill the last dent of the reed"},
        {"warp.density", warning, "the warp has the density of the harness, give or take a hundredth"},
        {"cloth.width", info, "width of the finished cloth against that in the reed"},
        {"consumption", info, "yarn used from each beam and feeder for a metre of cloth and for the design"},
    };
    return all;
}

}  // namespace weave
