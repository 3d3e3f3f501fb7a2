<?xml version="1.0" encoding="utf-8"?>
<!DOCTYPE TS>
<TS version="2.1" language="en" sourcelanguage="en">
<context>
    <name>PictureStencil</name>
    <message numerus="yes">
        <source>%1 is no card: a card is black and white only, and this picture has %n colour(s).</source>
        <translation>
            <numerusform>%1 is no card: a card is black and white only, and this picture has %n colour.</numerusform>
            <numerusform>%1 is no card: a card is black and white only, and this picture has %n colours.</numerusform>
        </translation>
    </message>
</context>
<context>
    <name>SliceEdits</name>
    <message numerus="yes">
        <source>Remove %n yarn(s)</source>
        <translation>
            <numerusform>Remove %n yarn</numerusform>
            <numerusform>Remove %n yarns</numerusform>
        </translation>
    </message>
    <message numerus="yes">
        <source>Duplicate %n yarn(s)</source>
        <translation>
            <numerusform>Duplicate %n yarn</numerusform>
            <numerusform>Duplicate %n yarns</numerusform>
        </translation>
    </message>
    <message numerus="yes">
        <source>Move %n yarn(s)</source>
        <translation>
            <numerusform>Move %n yarn</numerusform>
            <numerusform>Move %n yarns</numerusform>
        </translation>
    </message>
    <message numerus="yes">
        <source>Enable %n weft(s)</source>
        <translation>
            <numerusform>Enable %n weft</numerusform>
            <numerusform>Enable %n wefts</numerusform>
        </translation>
    </message>
    <message numerus="yes">
        <source>Disable %n weft(s)</source>
        <translation>
            <numerusform>Disable %n weft</numerusform>
            <numerusform>Disable %n wefts</numerusform>
        </translation>
    </message>
</context>
<context>
    <name>StateWords</name>
    <message numerus="yes">
        <source>%n step(s)</source>
        <translation>
            <numerusform>%n step</numerusform>
            <numerusform>%n steps</numerusform>
        </translation>
    </message>
    <message numerus="yes">
        <source>; %n crossing(s) no longer lie as the card says</source>
        <translation>
            <numerusform>; %n crossing no longer lies as the card says</numerusform>
            <numerusform>; %n crossings no longer lie as the card says</numerusform>
        </translation>
    </message>
    <message numerus="yes">
        <source>%n crossing(s) no longer lie as the card says</source>
        <translation>
            <numerusform>%n crossing no longer lies as the card says</numerusform>
            <numerusform>%n crossings no longer lie as the card says</numerusform>
        </translation>
    </message>
    <message numerus="yes">
        <source>%n yarn(s) are jammed, tightest at %1</source>
        <translation>
            <numerusform>%n yarn is jammed at %1</numerusform>
            <numerusform>%n yarns are jammed, tightest at %1</numerusform>
        </translation>
    </message>
    <message numerus="yes">
        <source>Falls apart into %n cloth(s) that nothing binds</source>
        <translation>
            <numerusform>Falls apart into %n cloth that nothing binds</numerusform>
            <numerusform>Falls apart into %n cloths that nothing binds</numerusform>
        </translation>
    </message>
    <message numerus="yes">
        <source>%n control point(s)</source>
        <translation>
            <numerusform>%n control point</numerusform>
            <numerusform>%n control points</numerusform>
        </translation>
    </message>
    <message numerus="yes">
        <source>%n yarn(s)</source>
        <translation>
            <numerusform>%n yarn</numerusform>
            <numerusform>%n yarns</numerusform>
        </translation>
    </message>
</context>
<context>
    <name>commands</name>
    <message numerus="yes">
        <source>Flip %n crossing(s)</source>
        <translation>
            <numerusform>Flip %n crossing</numerusform>
            <numerusform>Flip %n crossings</numerusform>
        </translation>
    </message>
</context>
<context>
    <name>weave::studio::CardEditor</name>
    <message numerus="yes">
        <source>%n pick(s)</source>
        <translation>
            <numerusform>%n pick</numerusform>
            <numerusform>%n picks</numerusform>
        </translation>
    </message>
    <message numerus="yes">
        <source>%n end(s)</source>
        <translation>
            <numerusform>%n end</numerusform>
            <numerusform>%n ends</numerusform>
        </translation>
    </message>
    <message numerus="yes">
        <source>%1 of %n crossing(s) stay as they are. The first: %2</source>
        <translation>
            <numerusform>%1 of %n crossing stays as it is. The first: %2</numerusform>
            <numerusform>%1 of %n crossings stay as they are. The first: %2</numerusform>
        </translation>
    </message>
</context>
<context>
    <name>weave::studio::DesignTree</name>
    <message numerus="yes">
        <source>stencil of %n block(s)</source>
        <translation>
            <numerusform>stencil of %n block</numerusform>
            <numerusform>stencil of %n blocks</numerusform>
        </translation>
    </message>
    <message numerus="yes">
        <source>, %n flip(s)</source>
        <translation>
            <numerusform>, %n flip</numerusform>
            <numerusform>, %n flips</numerusform>
        </translation>
    </message>
</context>
<context>
    <name>weave::studio::FindingsPanel</name>
    <message numerus="yes">
        <source>%n rule(s) held</source>
        <translation>
            <numerusform>%n rule held</numerusform>
            <numerusform>%n rules held</numerusform>
        </translation>
    </message>
    <message numerus="yes">
        <source>%n error(s)</source>
        <translation>
            <numerusform>%n error</numerusform>
            <numerusform>%n errors</numerusform>
        </translation>
    </message>
    <message numerus="yes">
        <source>%n warning(s)</source>
        <translation>
            <numerusform>%n warning</numerusform>
            <numerusform>%n warnings</numerusform>
        </translation>
    </message>
</context>
<context>
    <name>weave::studio::MainWindow</name>
    <message numerus="yes">
        <source>The studio was ended before this design was saved. The design is here again, with its last %n step(s); undo takes them back.</source>
        <translation>
            <numerusform>The studio was ended before this design was saved. The design is here again, with its last step; undo takes it back.</numerusform>
            <numerusform>The studio was ended before this design was saved. The design is here again, with its last %n steps; undo takes them back.</numerusform>
        </translation>
    </message>
</context>
<context>
    <name>weave::studio::PictureMapDialog</name>
    <message numerus="yes">
        <source>%n colour(s) are still without a block</source>
        <translation>
            <numerusform>%n colour is still without a block</numerusform>
            <numerusform>%n colours are still without a block</numerusform>
        </translation>
    </message>
</context>
<context>
    <name>weave::studio::PresetDialog</name>
    <message numerus="yes">
        <source>%n pick(s)</source>
        <translation>
            <numerusform>%n pick</numerusform>
            <numerusform>%n picks</numerusform>
        </translation>
    </message>
    <message numerus="yes">
        <source>%n end(s)</source>
        <translation>
            <numerusform>%n end</numerusform>
            <numerusform>%n ends</numerusform>
        </translation>
    </message>
</context>
<context>
    <name>weave::studio::SubmitPanel</name>
    <message numerus="yes">
        <source>The design has %n error(s). The mill may keep a submission that has errors, but nobody can approve it until they are gone or let pass.</source>
        <translation>
            <numerusform>The design has %n error. The mill may keep a submission that has errors, but nobody can approve it until it is gone or let pass.</numerusform>
            <numerusform>The design has %n errors. The mill may keep a submission that has errors, but nobody can approve it until they are gone or let pass.</numerusform>
        </translation>
    </message>
    <message numerus="yes">
        <source>%Ln pick(s)</source>
        <translation>
            <numerusform>%Ln pick</numerusform>
            <numerusform>%Ln picks</numerusform>
        </translation>
    </message>
    <message numerus="yes">
        <source>%Ln end(s)</source>
        <translation>
            <numerusform>%Ln end</numerusform>
            <numerusform>%Ln ends</numerusform>
        </translation>
    </message>
</context>
</TS>
