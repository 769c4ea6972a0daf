#include "gui/window/start_window.hpp"

#include <backends/imgui_impl_opengl3.h>

#include <algorithm>
#include <chrono>
#include <thread>

#include "gui/dashboard/drawn_texts.hpp"
#include "gui/render/gl.hpp"
#include "gui/window/browser_controller.hpp"
#include "gui/window/demo_pictures.hpp"
#include "gui/window/grounds.hpp"
#include "gui/window/panel_image.hpp"
#include "gui/window/screenshots.hpp"
#include "gui/window/start_controller.hpp"
#include "gui/window/stop_signal.hpp"
#include "gui/window/window.hpp"
#include "ipc/base/whole_file.hpp"

namespace tact {
namespace {

class StartWindow {
public:
    explicit StartWindow(const GuiOptions& options)
        : options_(options),
          window_(options.width_px, options.height_px, options.hidden, options.ui_scale),
          controller_(options.scene_switch),
          browser_(options.scene_switch) {
        page_.demos = demo_cards();
        pictures_.emplace(page_.demos);
        browser_.refresh(lists_);
    }

    int run() {
        constexpr auto kIdle = std::chrono::milliseconds(12), kRest = std::chrono::milliseconds(100);
        const Instant begun = Monotonic::now();
        Instant drawn{}, input_at{};
        for (bool last = false; !last;) {
            const Instant now = Monotonic::now();
            last = stop_signal() != 0 || window_.close_wanted() ||
                   (options_.seconds > 0.0 && to_s(now - begun) >= options_.seconds);
            if (window_.take_input()) input_at = now;
            // Follows input at once, and rests otherwise.
            if (!last && now - drawn < (now - input_at < PanelImage::kAfterInput ? kIdle : kRest)) {
                std::this_thread::sleep_for(kIdle / 2);
                continue;
            }
            drawn = now;
            frame(last);
        }
        return screenshots_.failed() ? 1 : 0;
    }

private:
    void frame(bool last) {
        window_.begin_panels(theme_);
        window_.bind();
        if (const auto dropped = window_.take_dropped(); !dropped.empty()) browser_.drop(dropped, lists_);
        browser_.follow(lists_);
        controller_.follow(page_);
        take_keys();
        const Window::Size size = window_.size();
        glViewport(0, 0, size.width_px, size.height_px);
        paint_ground();
        const ImGuiIO& io = ImGui::GetIO();
        const PixelRect area{0.0F, 0.0F, io.DisplaySize.x, io.DisplaySize.y};
        draw_start_page(theme_, page_, lists_, area);
        if (lists_.open) draw_browser(theme_, lists_, area);
        ImGui::Render();
        ImGui_ImplOpenGL3_RenderDrawData(ImGui::GetDrawData());
        if (!options_.texts.empty())
            write_whole_file(options_.texts, texts_json(drawn_texts(*ImGui::GetDrawData())));
        if (last && screenshots_.wanted_at_end()) screenshots_.save_at_end(window_.picture());
        window_.show();
    }

    void take_keys() {
        KeySituation now;
        now.browser = lists_.open;
        for (const KeyStroke& stroke : window_.take_keys()) {
            if (ImGui::GetIO().WantTextInput) continue;
            const KeyFound found = options_.keys.find(stroke, now);
            if (found.row == nullptr) continue;
            if (found.row->action == KeyAction::open_browser) lists_.open = !lists_.open;
            if (found.row->action == KeyAction::close_browser) lists_.open = false;
        }
    }

    const GuiOptions& options_;
    Window window_;
    Theme theme_;
    StartPageState page_;
    BrowserState lists_;
    StartController controller_;
    BrowserController browser_;
    std::optional<DemoPictures> pictures_;  // destroyed before the window
    Screenshots screenshots_{options_.screenshot, 0.0, {}};
};

}  // namespace

int run_start_page(const GuiOptions& options) {
    catch_stop_signals();
    return StartWindow(options).run();
}

}  // namespace tact
