// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#include "app/studio.h"

#include <filesystem>

namespace thaw::editor {

namespace fs = std::filesystem;

namespace {
constexpr double kNoticeSeconds = 8, kAutosaveSeconds = 5;
}

Studio::Studio(const Options& options)
    : settings(loadSettings(options.places)), places(options.places), simulation_(options.threads),
      threads_(options.threads), autosave_(options.places) {
    thawInitBudget(&orders_.budget);
    orders_.budget.mode = thawBudget_milliseconds;
    lost = autosave_.lost();
}

Studio::~Studio() = default;

bool Studio::edit(const std::string& what, const std::function<void(scene::Scene&)>& change,
                  const std::string& gesture) {
    try {
        return document_.edit(what, change, gesture);
    } catch (const std::exception& e) {
        tell(what + ": " + e.what(), true);
        return false;
    }
}

void Studio::undo() {
    const std::string what = document_.undoText();
    if (what.empty()) return tell("nothing to undo");
    document_.undo();
    tell("undone: " + what);
}

void Studio::redo() {
    const std::string what = document_.redoText();
    if (what.empty()) return tell("nothing to redo");
    document_.redo();
    tell("done again: " + what);
}

void Studio::create() {
    document_.create();
    ++sceneNumber_;
    select({});
    reset();
}

bool Studio::open(const std::string& path) {
    try {
        document_.open(path);
    } catch (const std::exception& e) {
        complain("This scene cannot be opened", e.what());
        return false;
    }
    ++sceneNumber_;
    settings.remember(path);
    saveSettings(places, settings);
    select({});
    play(false), reset();
    tell("opened " + path);
    return true;
}

bool Studio::save() {
    if (document_.path().empty()) {
        asksForName = true;
        return false;
    }
    return saveAs(document_.path());
}

bool Studio::saveAs(const std::string& path) {
    try {
        document_.saveAs(path);
    } catch (const std::exception& e) {
        complain("The scene is not saved", std::string(e.what()) +
                                               "\n\nThe file is what it was, and your work is still "
                                               "here: save it somewhere else.");
        return false;
    }
    settings.remember(path);
    saveSettings(places, settings);
    tell("saved " + path);
    return true;
}

void Studio::recover(const Lost& from) {
    try {
        document_.recover(from.text, from.directory, from.path);
    } catch (const std::exception& e) {
        return complain("This work cannot be recovered", e.what());
    }
    Autosave::discard(from);
    ++sceneNumber_;
    select({});
    reset();
    tell("recovered; save it to keep it");
}

void Studio::guarded(std::function<void()> then) {
    if (document_.unsaved())
        pending = std::move(then);
    else
        then();
}

void Studio::import(const std::string& path) { importing = path; }

void Studio::select(Item item) {
    if (selection_ == item) return;
    selection_ = item;
    node = -1, contour = 0;
}

void Studio::removeSelection() {
    const Item item = selection_;
    if (!exists(scene(), item) || item.kind == Kind::world || item.kind == Kind::camera) return;
    const std::string title = titleOf(scene(), item);
    if (edit(std::string("Delete ") + kindName(item.kind) + " " + title, [&](scene::Scene& s) { erase(s, item); }))
        select({}), tell("deleted " + title + " (Ctrl+Z brings it back)");
}

void Studio::duplicateSelection() {
    const Item item = selection_;
    if (!exists(scene(), item) || item.kind == Kind::world || item.kind == Kind::camera) return;
    Item made;
    if (edit(std::string("Duplicate ") + titleOf(scene(), item), [&](scene::Scene& s) { made = duplicate(s, item); }))
        select(made);
}

void Studio::play(bool on) { orders_.playing = on; }

void Studio::stepOnce() {
    orders_.playing = false;
    ++orders_.steps;
}

void Studio::reset() { ++orders_.resets; }

void Studio::seek(int64_t to) {
    orders_.playing = false;
    orders_.seekTo = to;
    ++orders_.seeks;
}

void Studio::update() {
    if (!exists(scene(), selection_)) select({});
    bool send = false;
    if (document_.revision() != shownRevision_) {
        shownRevision_ = orders_.revision = document_.revision();
        orders_.scene = std::make_shared<const scene::Scene>(scene());
        pickerStale_ = true;
        meltHash_ = meltHash(scene());
        send = true;
    }
    followReference();
    orders_.budget.milliseconds = budget();
    orders_.particles = tool == Tool::probe || hasPickedParticle || scene::isOfParticles(view.picture) ||
                        view.picture == scene::PictureView::splats;
    orders_.featureSizes = view.picture == scene::PictureView::elfs;
    orders_.splats = view.picture == scene::PictureView::splats;
    send = send || orders_.playing != sent_.playing || orders_.speed != sent_.speed || orders_.loopAt != sent_.loopAt ||
           orders_.resets != sent_.resets || orders_.steps != sent_.steps || orders_.seeks != sent_.seeks ||
           orders_.budget.milliseconds != sent_.budget.milliseconds || orders_.budget.mode != sent_.budget.mode ||
           orders_.particles != sent_.particles || orders_.featureSizes != sent_.featureSizes ||
           orders_.splats != sent_.splats;
    if (send) simulation_.send(orders_), sent_ = orders_;

    const std::string before = frame().error;
    if (simulation_.receive()) {
        pickerStale_ = true;
        ++framesTaken_;
        if (!frame().error.empty() && frame().error != before) tell(frame().error, true);
    }

    const double time = now();
    if (time >= nextAutosave_) {
        if (const std::string why = autosave_.keep(document_); !why.empty()) tell("no autosave: " + why, true);
        nextAutosave_ = time + kAutosaveSeconds;
    }
    if (notice_.until < time) notice_ = {};
}

void Studio::makeReference() {
    if (document_.path().empty()) return tell("save the scene first: the reference is stored beside it", true);
    play(false);
    referenceRun_.start(scene(), threads_);
}

void Studio::followReference() {
    if (std::optional<ReferenceRun::Result> made = referenceRun_.take()) {
        if (!made->error.empty()) return complain("There is no reference", made->error);
        try {
            saveReference(made->reference, referencePath(document_.path()));
            tell("stored " + referencePath(document_.path()));
        } catch (const std::exception& e) {
            complain("The reference is not stored", e.what());
        }
        reference_ = std::move(made->reference);
        referenceFile_ = document_.path();
    }
    if (referenceFile_ != document_.path()) {
        referenceFile_ = document_.path();
        reference_ = referenceFile_.empty() ? std::nullopt : loadReference(referencePath(referenceFile_));
    }
}

Picker& Studio::picker() {
    if (pickerStale_) {
        const Frame& f = frame();
        picker_.setScene(f.scene, f.meshes, f.colliders);
        picker_.setMelt(f.mesh.view(), f.bodyOfIndex);
        pickerStale_ = false;
    }
    return picker_;
}

void Studio::tell(const std::string& text, bool bad) {
    notice_ = {scene::oneLine(text, 400), bad, now() + kNoticeSeconds};
}

void Studio::complain(const std::string& title, const std::string& text) { complaints.push_back({title, text}); }

} // namespace thaw::editor
