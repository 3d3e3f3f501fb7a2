#include <studio/viewport/words.hpp>

#include <QCoreApplication>

namespace weave::studio {

namespace {

struct Words {
    Q_DECLARE_TR_FUNCTIONS(Viewport)
};

}  // namespace

QString yarn_words(const TubeModel& model, std::uint32_t yarn, const Vec3& place) {
    const ModelYarn& of = model.yarns()[yarn];
    const qulonglong number = model.number_at(yarn, place) + 1;
    if (of.system == System::weft) return Words::tr("pick %1").arg(number);
    return Words::tr("end %1 · beam %2").arg(number).arg(of.beam + 1);
}

QString face_name(Face face) {
    switch (face) {
        case Face::plus_x:
            return Words::tr("Last pick");
        case Face::minus_x:
            return Words::tr("Pick 1");
        case Face::plus_y:
            return Words::tr("Last end");
        case Face::minus_y:
            return Words::tr("End 1");
        case Face::plus_z:
            return Words::tr("Face");
        case Face::minus_z:
            break;
    }
    return Words::tr("Back");
}

QString attach_words(Face face) {
    switch (face) {
        case Face::plus_x:
            return Words::tr("attach here: after the last pick (+x)");
        case Face::minus_x:
            return Words::tr("attach here: before pick 1 (−x)");
        case Face::plus_y:
            return Words::tr("attach here: right of the last end (+y)");
        case Face::minus_y:
            return Words::tr("attach here: left of end 1 (−y)");
        case Face::plus_z:
            return Words::tr("attach here: on the face (+z)");
        case Face::minus_z:
            break;
    }
    return Words::tr("attach here: on the back (−z)");
}

QString colour_name(ColourBy colour) {
    switch (colour) {
        case ColourBy::yarn:
            return Words::tr("Yarn");
        case ColourBy::system:
            return Words::tr("Warp and weft");
        case ColourBy::strain:
            return Words::tr("Strain");
        case ColourBy::contact:
            return Words::tr("Contact force");
        case ColourBy::moved:
            break;
    }
    return Words::tr("Distance from the plan");
}

QString scale_title(ColourBy colour) {
    switch (colour) {
        case ColourBy::strain:
            return Words::tr("strain, %");
        case ColourBy::contact:
            return Words::tr("contact force, N");
        case ColourBy::moved:
            return Words::tr("from the plan, mm");
        case ColourBy::yarn:
        case ColourBy::system:
            break;
    }
    return {};
}

QString view_name(StandardView view) {
    switch (view) {
        case StandardView::face:
            return Words::tr("Face");
        case StandardView::back:
            return Words::tr("Back");
        case StandardView::warp_side:
            return Words::tr("Warp side (ends run left to right)");
        case StandardView::weft_side:
            return Words::tr("Weft side (picks run left to right)");
        case StandardView::corner:
            return Words::tr("Corner");
        case StandardView::opposite_corner:
            break;
    }
    return Words::tr("Opposite corner, from below");
}

}  // namespace weave::studio
