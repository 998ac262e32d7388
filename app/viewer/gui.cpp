#include "app/viewer/gui.h"

#include <imgui.h>

#include <algorithm>

#include "app/viewer/gui_drawing.h"
#include "skitter/renderer.h"

namespace skitter::app {
namespace {

const ImVec4 accent{1.0f, 0.78f, 0.36f, 1};
constexpr ImGuiWindowFlags panel = ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove |
                                   ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_NoFocusOnAppearing |
                                   ImGuiWindowFlags_NoNav;

void style(float scale) {
  ImGui::StyleColorsDark();
  ImGuiStyle& s = ImGui::GetStyle();
  s.WindowRounding = 6;
  s.WindowBorderSize = 0;
  s.WindowPadding = {12, 10};
  s.ItemSpacing = {10, 4};
  s.CellPadding = {6, 2};
  s.Colors[ImGuiCol_WindowBg] = {0.06f, 0.07f, 0.08f, 0.93f};
  s.Colors[ImGuiCol_Text] = {0.93f, 0.94f, 0.95f, 1};
  s.Colors[ImGuiCol_HeaderHovered] = {1, 1, 1, 0.14f};
  s.Colors[ImGuiCol_HeaderActive] = {1, 1, 1, 0.24f};
  s.ScaleAllSizes(scale);
}

void heading(const char* text) { ImGui::TextColored(accent, "%s", text); }

}  // namespace

struct Gui::Impl {
  explicit Impl(float scale) {
    context = ImGui::CreateContext();
    ImGuiIO& io = ImGui::GetIO();
    io.IniFilename = nullptr;
    io.LogFilename = nullptr;
    io.BackendFlags |= ImGuiBackendFlags_RendererHasVtxOffset;
    ImFontConfig font;
    font.SizePixels = 13 * scale;
    io.Fonts->AddFontDefault(&font);
    style(scale);
  }
  ~Impl() { ImGui::DestroyContext(context); }

  ImGuiContext* context = nullptr;
  std::optional<GuiDrawing> drawing;
  float margin = 10;
};

Gui::Gui(const gpu::Context& context, float scale) : impl_(std::make_unique<Impl>(scale)) {
  impl_->drawing.emplace(context, *ImGui::GetIO().Fonts, vk::Format(Renderer::colourFormat));
}
Gui::~Gui() = default;

void Gui::begin(Size size, float seconds, const Input& input) {
  ImGuiIO& io = ImGui::GetIO();
  io.DisplaySize = {static_cast<float>(size.width), static_cast<float>(size.height)};
  io.DeltaTime = std::max(seconds, 1e-4f);
  io.MousePos = {input.mouse.x, input.mouse.y};
  io.MouseDown[0] = input.held;
  io.MouseWheel = input.wheel;
  ImGui::NewFrame();
}

bool Gui::hasMouse() const { return ImGui::GetIO().WantCaptureMouse; }
ImDrawList& Gui::underneath() { return *ImGui::GetBackgroundDrawList(); }

std::optional<Action> Gui::help() {
  std::optional<Action> chosen;
  const ImVec2 display = ImGui::GetIO().DisplaySize;
  ImGui::SetNextWindowPos({display.x / 2, display.y / 2}, ImGuiCond_Always, {0.5f, 0.5f});
  ImGui::SetNextWindowSizeConstraints({0, 0}, {display.x - 2 * impl_->margin, display.y - 2 * impl_->margin});
  ImGui::Begin("help", nullptr, (panel & ~ImGuiWindowFlags_NoScrollbar) | ImGuiWindowFlags_AlwaysAutoResize);
  if (ImGui::BeginTable("keys", 2, ImGuiTableFlags_SizingFixedFit)) {
    const char* group = "";
    for (const KeyRow& row : keyRows()) {
      ImGui::TableNextRow();
      ImGui::TableNextColumn();
      if (std::string(row.group) != group) {
        group = row.group;
        if (ImGui::TableGetRowIndex() > 0) ImGui::Spacing();
        heading(group);
        ImGui::TableNextRow();
        ImGui::TableNextColumn();
      }
      if (row.action == Action::none || row.held) {
        ImGui::TextUnformatted(row.name);
      } else if (ImGui::Selectable(row.name, false, ImGuiSelectableFlags_SpanAllColumns)) {
        chosen = row.action;
      }
      ImGui::TableNextColumn();
      ImGui::TextUnformatted(row.text);
    }
    ImGui::EndTable();
  }
  ImGui::End();
  return chosen;
}

void Gui::figures(const Figures& figures) {
  ImGui::SetNextWindowPos({impl_->margin, impl_->margin});
  ImGui::Begin("figures", nullptr, panel | ImGuiWindowFlags_AlwaysAutoResize | ImGuiWindowFlags_NoInputs);
  if (ImGui::BeginTable("figures", 2, ImGuiTableFlags_SizingFixedFit)) {
    for (const auto& [name, value] : figures) {
      ImGui::TableNextRow();
      ImGui::TableNextColumn();
      if (value.empty()) ImGui::Spacing();
      value.empty() ? heading(name.c_str()) : ImGui::TextUnformatted(name.c_str());
      ImGui::TableNextColumn();
      ImGui::TextUnformatted(value.c_str());
    }
    ImGui::EndTable();
  }
  ImGui::End();
}

void Gui::message(const std::string& text) {
  const ImVec2 display = ImGui::GetIO().DisplaySize;
  ImGui::SetNextWindowPos({display.x / 2, display.y - 2 * impl_->margin}, ImGuiCond_Always, {0.5f, 1});
  ImGui::Begin("message", nullptr, panel | ImGuiWindowFlags_AlwaysAutoResize | ImGuiWindowFlags_NoInputs);
  ImGui::PushTextWrapPos(0.8f * display.x);
  ImGui::TextUnformatted(text.c_str());
  ImGui::PopTextWrapPos();
  ImGui::End();
}

void Gui::end() { ImGui::Render(); }
void Gui::draw(vk::CommandBuffer cmd) { impl_->drawing->draw(cmd, *ImGui::GetDrawData()); }

}  // namespace skitter::app
