#pragma once

#include <algorithm>
#include <map>
#include <string>
#include <vector>

#include "models/base/json.h"
#include "twin/render/recording.h"

namespace tubetwin {

/// A cell of one straight tube in the bin, a gripper of two pads on a slide above it, and nothing
/// else; coordinate 0 is the slide's height. `attempts` of two seconds each: down, and up again.
inline Recording SmallRecording(int attempts) {
  Recording recording;
  recording.cell_xml =
      "<mujoco><worldbody>"
      "<geom name='bin_floor' type='box' size='0.385 0.29 0.01' pos='0.6 0 0.09' "
      "euler='0 0 90'/>"
      "<body name='arm_base'><geom name='arm_base' type='cylinder' size='0.1 0.1'/></body>"
      "<body name='tool' pos='0.6 0 0.4'><joint type='slide' axis='0 0 1'/>"
      "<geom name='pad_left' type='box' size='0.01 0.003 0.02' pos='0 0.02 0' mass='1'/>"
      "<geom name='pad_right' type='box' size='0.01 0.003 0.02' pos='0 -0.02 0' mass='1'/></body>"
      "<body name='tube1' pos='0.6 0 0.1125'>"
      "<geom name='tube1_g1' type='capsule' size='0.0125' fromto='0.05 0 0 0.2 0 0'/>"
      "<geom name='tube1_g0' type='capsule' size='0.0125' fromto='-0.1 0 0 0.05 0 0'/></body>"
      "</worldbody></mujoco>";
  recording.captions = {"approaching", "weighing"};
  constexpr int kFrames = 60;
  for (int attempt = 0; attempt < attempts; ++attempt) {
    Recording::Overlay look;
    look.lines_N = {{{0.0, -0.1, 0.0125}, {0.0, 0.2, 0.0125}}};
    look.classes = {attempt % 3};
    look.target = 0;
    look.cloud_N = {{0.01, 0.02, 0.025}, {-0.1, 0.0, 0.0}};
    recording.overlays.push_back(look);
    for (int i = 0; i < kFrames; ++i) {
      Recording::Frame frame;
      frame.qpos = {-0.01f * static_cast<float>(std::min(i, kFrames - i))};
      frame.force_N = i < kFrames / 2 ? 0.0f : 0.54f;
      frame.overlay = i < 10 ? -1 : attempt;
      frame.caption = i < kFrames / 2 ? 0 : 1;
      recording.frames.push_back(frame);
    }
    recording.attempt_ends.push_back(static_cast<int>(recording.frames.size()));
  }
  return recording;
}

/// Value of every `<data value=V data-at=P>T</data>` of a page, by P, with its text T.
inline std::map<std::string, std::pair<std::string, std::string>> ShownNumbers(
    const std::string& html) {
  std::map<std::string, std::pair<std::string, std::string>> out;
  const std::string open = "<data value=\"", middle = "\" data-at=\"", close = "</data>";
  for (std::size_t at = html.find(open); at != std::string::npos; at = html.find(open, at + 1)) {
    const std::size_t value = at + open.size(), value_end = html.find('"', value);
    const std::size_t name = value_end + middle.size(), name_end = html.find('"', name);
    const std::size_t text = name_end + 2, text_end = html.find(close, text);
    out[html.substr(name, name_end - name)] = {html.substr(value, value_end - value),
                                               html.substr(text, text_end - text)};
  }
  return out;
}

inline int CountOf(const std::string& text, const std::string& what) {
  int count = 0;
  for (std::size_t at = text.find(what); at != std::string::npos; at = text.find(what, at + 1)) {
    ++count;
  }
  return count;
}

/// The page without its scripts and data: what a reader without scripts gets.
inline std::string Markup(const std::string& html) { return html.substr(0, html.find("<script")); }

/// Whether what must be closed is closed.
inline std::vector<std::string> UnbalancedTags(const std::string& markup) {
  std::vector<std::string> out;
  for (const std::string tag :
       {"table", "tr",   "td",      "th",      "div",     "figure", "svg",
        "p",     "h1",   "h2",      "h3",      "section", "data",   "figcaption",
        "title", "text", "details", "summary", "article", "select", "option",
        "g",     "span", "b",       "a",       "pre",     "footer", "header",
        "dl",    "dt",   "dd",      "label",   "button"}) {
    if (CountOf(markup, "<" + tag + ">") + CountOf(markup, "<" + tag + " ") !=
        CountOf(markup, "</" + tag + ">")) {
      out.push_back(tag);
    }
  }
  return out;
}

}  // namespace tubetwin
