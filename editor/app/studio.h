// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#pragma once

#include "model/autosave.h"
#include "model/document.h"
#include "model/items.h"
#include "model/pick.h"
#include "model/reference.h"
#include "model/settings.h"
#include "model/simulation.h"
#include "player/scene_stage.h"

#include <deque>
#include <functional>
#include <memory>
#include <optional>
#include <string>

namespace thaw::editor {

enum class Tool { select, move, turn, scale, path, shape, source, collider, temperature, absorptivity, erase, probe };
constexpr int kTools = 12;

/// What the tools make, as set beside them.
struct ToolSettings {
    float pathSmoothing = 3; // passes over a drawn line
    thawHeatSourceType source = thawHeatSource_point;
    float sourceDistance = 0; // m off the surface; 0: chosen by the spacing
    scene::ShapeType collider = scene::ShapeType::box;
    float colliderSize = 0.03f;                // m across
    float brushRadius = 0.01f, falloff = 0.5f; // m, 1
    float paintTemperature = 350;              // K
    float paintAbsorptivity = 1;
};

/// How the melt and the stage are looked at.
struct ViewSettings {
    scene::PictureView picture = scene::PictureView::shaded;
    bool controls = true;      // paths and shapes are drawn over it
    bool icons = true;         // heat sources, nodes, axes
    bool clip = false;         // what lies before a plane through the middle of the scene is left out
    int clipAxis = 2;          // of the plane: x, y, z
    float clipOffset = 0;      // m from the middle, to the viewer
    bool followCamera = false; // the scene's own, along its keys
};

/// Everything that panels and tools act on. It knows nothing of windows: what it needs of one is asked for by the
/// flags below.
class Studio {
public:
    struct Options {
        Places places;
        int threads = 2;
    };
    explicit Studio(const Options& options);
    ~Studio();

    // ---- the scene

    const scene::Scene& scene() const { return document_.scene(); }
    const Document& document() const { return document_; }
    /// Another one for each scene that was opened or begun.
    uint64_t sceneNumber() const { return sceneNumber_; }
    /// Changes the scene; what cannot be is told in the status line, and false.
    bool edit(const std::string& what, const std::function<void(scene::Scene&)>& change,
              const std::string& gesture = {});
    void endGesture() { document_.endGesture(); }
    void undo();
    void redo();

    /// These say in a dialog what did not work, and false.
    bool open(const std::string& path);
    bool save(); // asks for a name first where there is none
    bool saveAs(const std::string& path);
    void create();
    void recover(const Lost& lost);
    /// Does it now, or after what is unsaved was saved or given up.
    void guarded(std::function<void()> then);
    /// A mesh file that was dropped or chosen: asked for size and axis, then added.
    void import(const std::string& path);

    // ---- what is chosen

    /// Nothing when it is not there any more.
    Item selection() const { return exists(scene(), selection_) ? selection_ : Item{}; }
    void select(Item item);
    void removeSelection();
    void duplicateSelection();
    /// A node of the chosen path or contour, -1 for none.
    int node = -1, contour = 0;

    // ---- time

    const Frame& frame() const { return simulation_.frame(); }
    /// Frames that came so far.
    uint64_t framesTaken() const { return framesTaken_; }
    bool playing() const { return orders_.playing; }
    void play(bool on);
    void stepOnce();
    void reset();
    void seek(int64_t frame);
    /// Set by panels; sent with the next update.
    Orders& orders() { return orders_; }
    const Orders& orders() const { return orders_; }
    /// Milliseconds that the governor may take; kept in the scene's defaults.
    float budget() const { return scene().defaults.budgetMilliseconds; }

    // ---- accuracy

    /// The stored reference run of this scene, null when there is none.
    const Reference* reference() const { return reference_ ? &*reference_ : nullptr; }
    /// Whether the scene is still the one that it was made of.
    bool referenceFits() const { return reference_ && reference_->hash == meltHash_; }
    /// Makes one; needs a file, beside which it is stored.
    void makeReference();
    ReferenceRun& referenceRun() { return referenceRun_; }

    // ---- every frame

    /// Takes the newest frame of the simulation, sends it what changed, keeps a copy of unsaved work.
    void update();
    /// Ready to be asked, with the melt as it is shown.
    Picker& picker();

    // ---- messages

    /// One line that stays for some seconds.
    void tell(const std::string& text, bool bad = false);
    /// A window with the reason, which must be closed.
    void complain(const std::string& title, const std::string& text);
    struct Notice {
        std::string text;
        bool bad = false;
        double until = 0;
    };
    const Notice& notice() const { return notice_; }
    struct Complaint {
        std::string title, text;
    };
    std::deque<Complaint> complaints;
    std::vector<Lost> lost; // to be asked about

    // ---- what panels keep

    Tool tool = Tool::select;
    ToolSettings tools;
    ViewSettings view;
    Settings settings;
    Places places;
    Last<Span, 512> spans;         // of this thread
    std::function<void()> pending; // waits for what is unsaved
    bool asksForName = false;      // save as
    bool asksForFile = false;      // open
    bool asksForMesh = false;      // import
    std::string importing;         // mesh file in the import dialog
    bool closing = false;          // the window may close
    uint32_t pickedParticle = 0;   // id
    bool hasPickedParticle = false;

private:
    void followReference();

    Document document_;
    Simulation simulation_;
    Orders orders_, sent_;
    Item selection_;
    Picker picker_;
    bool pickerStale_ = true;
    std::optional<Reference> reference_;
    std::string referenceFile_;
    ReferenceRun referenceRun_;
    uint64_t meltHash_ = 0;
    int threads_;
    Notice notice_;
    Autosave autosave_;
    double nextAutosave_ = 0;
    uint64_t shownRevision_ = ~0ull, framesTaken_ = 0, sceneNumber_ = 1;
};

} // namespace thaw::editor
