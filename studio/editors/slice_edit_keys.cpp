// The keys, actions and menu of the slice's drawing.

#include <studio/editors/own_keys.hpp>
#include <studio/editors/slice_edit_canvas.hpp>

#include <QContextMenuEvent>
#include <QKeyEvent>
#include <QMenu>

#include <algorithm>

namespace weave::studio {

QAction* SliceEditCanvas::make(const QString& name, const QString& text, const QKeySequence& keys,
                               const std::function<void()>& what) {
    auto* action = new QAction(text, this);
    action->setObjectName(name);
    action->setShortcut(keys);
    action->setShortcutContext(Qt::WidgetShortcut);
    action->setShortcutVisibleInContextMenu(true);
    action->setToolTip(tr("%1 (%2)").arg(text, keys.toString(QKeySequence::NativeText)));
    connect(action, &QAction::triggered, this, what);
    addAction(action);
    return action;
}

void SliceEditCanvas::make_tool(SliceTool tool, const QString& name, const QKeySequence& keys) {
    QAction* action = make(name, {}, keys, [this, tool] { set_tool(tool); });
    action->setCheckable(true);
    m_tools.addAction(action);
}

void SliceEditCanvas::make_actions() {
    make_tool(SliceTool::select, "select", Qt::Key_S);
    make_tool(SliceTool::draw, "draw", Qt::Key_D);
    make_tool(SliceTool::add_path, "add_path", Qt::Key_A);
    make_tool(SliceTool::add_dot, "add_dot", Qt::Key_W);
    const auto& chosen = m_marks.selected;
    make("remove", tr("Remove"), QKeySequence::Delete,
         [&] { apply_at_marks(remove_chosen(m_slice, chosen)); });
    make("duplicate", tr("Duplicate"), Qt::CTRL | Qt::Key_D,
         [&] { apply_at_marks(duplicate_chosen(m_slice, chosen)); });
    make("enable", tr("Enable or disable weft"), Qt::Key_E,
         [&] { apply_at_marks(enable_chosen(m_slice, chosen)); });
    make("insert", tr("Add a yarn like it"), Qt::Key_Insert,
         [&] { apply_at_marks(add_like(m_slice, chosen)); });
    make("earlier", tr("Earlier on the loom"), Qt::CTRL | Qt::Key_Left,
         [&] { apply_at_marks(renumber_chosen(m_slice, chosen, -1)); });
    make("later", tr("Later on the loom"), Qt::CTRL | Qt::Key_Right,
         [&] { apply_at_marks(renumber_chosen(m_slice, chosen, 1)); });
    action("earlier")->setShortcuts({Qt::CTRL | Qt::Key_Left, Qt::CTRL | Qt::Key_Down});
    action("later")->setShortcuts({Qt::CTRL | Qt::Key_Right, Qt::CTRL | Qt::Key_Up});
    make("insert_position", tr("Insert a position after"), Qt::SHIFT | Qt::Key_Insert,
         [this] { edit_place(PositionEdit::insert); });
    make("duplicate_position", tr("Duplicate the position"), Qt::CTRL | Qt::SHIFT | Qt::Key_D,
         [this] { edit_place(PositionEdit::duplicate); });
    make("remove_position", tr("Remove the position"), Qt::SHIFT | Qt::Key_Delete,
         [this] { edit_place(PositionEdit::remove); });
    make("position_earlier", tr("Move the position to the left"), Qt::ALT | Qt::SHIFT | Qt::Key_Left,
         [this] { edit_place(PositionEdit::earlier); });
    make("position_later", tr("Move the position to the right"), Qt::ALT | Qt::SHIFT | Qt::Key_Right,
         [this] { edit_place(PositionEdit::later); });
    make("raise", tr("Raise by an empty place"), Qt::ALT | Qt::Key_Up,
         [this] { edit_place(PositionEdit::raise); });
    make("lower", tr("Lower by an empty place"), Qt::ALT | Qt::Key_Down,
         [this] { edit_place(PositionEdit::lower); });
    make("close_up", tr("Close up empty levels"), Qt::CTRL | Qt::Key_L,
         [this] { apply_at_marks(close_up_levels(m_slice)); });
    make("turn", {}, Qt::CTRL | Qt::Key_T, [this] { apply_at_marks(turn(m_slice)); });
    make("next_yarn", tr("Next yarn"), Qt::Key_N, [this] { step_yarn(1); });
    make("previous_yarn", tr("Previous yarn"), Qt::Key_P, [this] { step_yarn(-1); });
    make("choose_all", tr("Choose all"), QKeySequence::SelectAll, [this] {
        const auto all = all_yarns();
        choose({all.begin(), all.end()});
    });
    make("fit", tr("Fit"), Qt::Key_F, [this] { fit(); });
    make("zoom_in", tr("Zoom in"), Qt::Key_Plus, [this] { zoom_in(); });
    make("zoom_out", tr("Zoom out"), Qt::Key_Minus, [this] { zoom_out(); });
    action("enable")->setIconText(tr("On/off"));
    action("insert")->setIconText(tr("Add like it"));
    action("earlier")->setIconText(tr("◂ Earlier"));
    action("later")->setIconText(tr("Later ▸"));
    action("insert_position")->setIconText(tr("+ Position"));
    name_tools();
}

void SliceEditCanvas::name_tools() {
    const auto name = [&](const char* tool, const QString& text, const QString& tip) {
        QAction* one = action(tool);
        one->setText(text);
        one->setToolTip(tr("%1 (%2)").arg(tip, one->shortcut().toString(QKeySequence::NativeText)));
    };
    const QString dot = kind_of_dots(m_slice), path = kind_of_paths(m_slice);
    name("select", tr("Choose"), tr("Click on yarns to choose them; Shift+click chooses several"));
    name("draw", tr("Draw"), tr("Press on a %1 and drag it through the gaps between the dots").arg(path));
    name("add_path", tr("Add %1").arg(path),
         tr("Drag from left to right through the dots: a new %1").arg(path));
    name("add_dot", tr("Add %1").arg(dot), tr("Click where a new %1 is to lie").arg(dot));
    const bool along_warp = m_slice.dots == System::weft;
    name("turn", along_warp ? tr("Draw along the weft") : tr("Draw along the warp"),
         along_warp ? tr("A weft slice: the drawing's wefts become warps, its warps wefts that run along it")
                    : tr("A warp slice: the drawing's warps become wefts, its wefts warps that run along it"));
}

void SliceEditCanvas::set_tool(SliceTool tool) {
    m_tool = tool;
    m_gesture.reset();
    m_marks.preview.reset();
    m_marks.dot_preview.reset();
    m_tools.actions()[static_cast<int>(tool)]->setChecked(true);
    update();
    Q_EMIT tool_changed(tool);
}

std::vector<SliceYarnId> SliceEditCanvas::all_yarns() const {
    std::vector<SliceYarnId> yarns;
    for (const SceneDot& dot : scene().dot_list) yarns.push_back(dot.yarn);
    for (const ScenePath& path : scene().paths) yarns.push_back(path.yarn);
    std::ranges::sort(yarns);
    return yarns;
}

void SliceEditCanvas::step_yarn(int step) {
    const auto yarns = all_yarns();
    if (yarns.empty()) return;
    const auto count = static_cast<std::ptrdiff_t>(yarns.size());
    std::ptrdiff_t at = step > 0 ? 0 : count - 1;
    if (!m_marks.selected.empty()) {
        at = std::ranges::find(yarns, *m_marks.selected.begin()) - yarns.begin();
        at = ((at + step) % count + count) % count;
    }
    choose({yarns[static_cast<std::size_t>(at)]});
    reveal(yarns[static_cast<std::size_t>(at)]);
}

void SliceEditCanvas::arrow_key(int up, int right) {
    if (m_slice.positions.empty()) return;
    if (m_marks.selected.empty()) return step_yarn(1);
    const SliceYarnId yarn = *m_marks.selected.begin();
    if (m_marks.selected.size() > 1 || !yarn.path)
        return apply_at_marks(move_chosen(m_slice, m_marks.selected, up, right));
    const std::size_t place = m_marks.path_place.value_or(0);
    if (right != 0) {
        const std::size_t last = m_slice.positions.size() - 1;
        m_marks.path_place = right > 0 ? std::min(place + 1, last) : place - std::min<std::size_t>(place, 1);
        m_last_position = *m_marks.path_place;
        reveal(yarn);
        return tell_chosen();
    }
    apply_at_marks(move_path(m_slice, yarn.number, place, up));
}

/// Our keys are ours while the drawing has the focus, whatever the window around it does with them.
bool SliceEditCanvas::event(QEvent* event) {
    return claims_key(*this, *event) || SliceCanvas::event(event);
}

void SliceEditCanvas::keyPressEvent(QKeyEvent* event) {
    if (QAction* own = action_of(*this, *event)) return own->trigger();
    const bool plain = (event->modifiers() & ~Qt::KeypadModifier) == Qt::NoModifier;
    switch (plain ? event->key() : 0) {
        case Qt::Key_Up:
            return arrow_key(1, 0);
        case Qt::Key_Down:
            return arrow_key(-1, 0);
        case Qt::Key_Left:
            return arrow_key(0, -1);
        case Qt::Key_Right:
            return arrow_key(0, 1);
        case Qt::Key_Escape:
            if (!m_gesture && m_marks.selected.empty()) break;
            m_gesture.reset();
            m_marks.preview.reset();
            return choose({});
        default:
            break;
    }
    SliceCanvas::keyPressEvent(event);
}

std::size_t SliceEditCanvas::place_in_question() const {
    if (m_marks.path_place) return *m_marks.path_place;
    if (!m_marks.selected.empty() && !m_marks.selected.begin()->path)
        return m_marks.selected.begin()->position;
    return m_slice.positions.empty() ? 0 : std::min(m_last_position, m_slice.positions.size() - 1);
}

std::size_t SliceEditCanvas::level_in_question() const {
    if (m_marks.selected.empty()) return 0;
    return level_of(m_slice, *m_marks.selected.begin(), place_in_question()).value_or(0);
}

void SliceEditCanvas::edit_place(PositionEdit edit) {
    const std::size_t position = place_in_question();
    Result<SliceEdit> result = edit_position(m_slice, edit, position, level_in_question());
    const bool stays = edit == PositionEdit::raise || edit == PositionEdit::lower;
    if (result && stays) result->chosen = m_marks.selected;
    apply_at_marks(std::move(result));
}

void SliceEditCanvas::contextMenuEvent(QContextMenuEvent* event) {
    if (event->reason() == QContextMenuEvent::Mouse) {
        const auto yarn = yarn_at(view(), scene(), event->pos());
        if (yarn && !m_marks.selected.contains(*yarn)) choose({*yarn});
        if (const auto position = view().column_at(event->pos().x(), m_slice.positions.size()))
            m_last_position = *position;
    }
    QMenu menu(this);
    menu.setObjectName("slice_menu");
    if (m_marks.selected.size() == 1) menu.addSection(told(m_slice, *m_marks.selected.begin()));
    for (const char* name : {"duplicate",
                             "remove",
                             "enable",
                             "insert",
                             "",
                             "earlier",
                             "later",
                             "raise",
                             "lower",
                             "",
                             "insert_position",
                             "duplicate_position",
                             "remove_position",
                             "position_earlier",
                             "position_later",
                             "close_up",
                             "turn",
                             "",
                             "select",
                             "draw",
                             "add_path",
                             "add_dot",
                             "",
                             "fit"}) {
        if (*name == 0) {
            menu.addSeparator();
        } else {
            menu.addAction(action(name));
        }
    }
    menu.exec(event->reason() == QContextMenuEvent::Mouse ? event->globalPos()
                                                          : mapToGlobal(place_of_marks()));
}

}  // namespace weave::studio
