// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT

#pragma once

#include "synthetic_candle.h"
#include "view/context.h"

#include <doctest/doctest.h>

namespace thaw::test {

/// A context and a renderer. Without them the case fails: a machine without EGL has to leave these tests out by label.
struct ViewFixture {
    std::unique_ptr<view::HeadlessContext> context;
    std::unique_ptr<view::Renderer> renderer;
    SyntheticCandle candle{192, 160};
    std::string error;

    ViewFixture() {
        context = view::HeadlessContext::create(error);
        REQUIRE_MESSAGE(context, error);
        renderer = view::Renderer::create(error);
        REQUIRE_MESSAGE(renderer, error);
    }
    static view::View smallView(view::ViewMode mode = view::ViewMode::shaded) {
        view::View v;
        v.width = 320, v.height = 180;
        v.camera = SyntheticCandle::camera(320.0f / 180);
        v.mode = mode;
        return v;
    }
    view::Image draw(const view::Scene& scene, const view::View& v) {
        std::optional<view::Image> image = renderer->capture(scene, v, error);
        REQUIRE_MESSAGE(image, error);
        return std::move(*image);
    }
};

} // namespace thaw::test
