#include <fmt/format.h>
#include <tinyxml2.h>

#include "app/common/law_watch.h"
#include "app/common/signals.h"
#include "app/validate/outcome.h"
#include "assets/files/partial_file.h"

namespace skitter::app {
namespace {

using tinyxml2::XMLElement;
using validation::StageResult;

void addFault(XMLElement& test, const char* kind, const std::string& message) {
  test.InsertNewChildElement(kind)->SetAttribute("message", message.c_str());
}

XMLElement& addCase(XMLElement& suite, const std::string& name, const char* of = "skitter.validate") {
  XMLElement& test = *suite.InsertNewChildElement("testcase");
  test.SetAttribute("classname", of);
  test.SetAttribute("name", name.c_str());
  return test;
}

void addProperties(XMLElement& suite, const nlohmann::ordered_json& manifest) {
  XMLElement* properties = suite.InsertNewChildElement("properties");
  for (const auto& [name, value] : manifest.items()) {
    if (value.is_null()) continue;
    XMLElement* property = properties->InsertNewChildElement("property");
    property->SetAttribute("name", name.c_str());
    property->SetAttribute("value", (value.is_string() ? value.get<std::string>() : value.dump()).c_str());
  }
}

void addSuite(XMLElement& suites, const Outcome& outcome, const nlohmann::ordered_json& manifest) {
  int64_t failures = 0;
  for (const StageResult& stage : outcome.stages) failures += stage.pass ? 0 : 1;
  const bool whole = outcome.isWhole();
  XMLElement& suite = *suites.InsertNewChildElement("testsuite");
  suite.SetAttribute("name", outcome.device.c_str());
  suite.SetAttribute("tests", static_cast<int64_t>(outcome.stages.size()) + (whole ? 0 : 1));
  suite.SetAttribute("failures", failures);
  suite.SetAttribute("errors", whole ? 0 : 1);
  suite.SetAttribute("time", fmt::format("{:.3f}", outcome.seconds).c_str());
  addProperties(suite, manifest);
  for (const StageResult& stage : outcome.stages) {
    XMLElement& test = addCase(suite, stage.name);
    if (!stage.pass) addFault(test, "failure", stage.why);
    test.InsertNewChildElement("system-out")
        ->SetText(fmt::format("{} samples, {} kept, {} ties, largest error {:.3g} of {:.3g}: {}",
                              stage.samples, stage.kept, stage.ties, stage.maxError, stage.tolerance,
                              stage.worst)
                      .c_str());
  }
  if (!whole)
    addFault(addCase(suite, "ticks"), "error", interruptedAfter(outcome.ticks, outcome.wanted, "ticks"));
}

// A case a herd and law.
void addLaws(XMLElement& suites, const Outcome& outcome) {
  if (outcome.laws.empty()) return;
  XMLElement& suite = *suites.InsertNewChildElement("testsuite");
  suite.SetAttribute("name", fmt::format("{}: laws of the visible world", outcome.device).c_str());
  suite.SetAttribute("tests", static_cast<int64_t>(outcome.laws.size()));
  suite.SetAttribute("failures", static_cast<int64_t>(brokenOf(outcome.laws).size()));
  for (const laws::Figure& figure : outcome.laws) {
    XMLElement& test =
        addCase(suite, fmt::format("{} of herd {}", laws::nameOf(figure.law), figure.herd), "skitter.laws");
    if (!figure.isKept) addFault(test, "failure", figure.text);
    test.InsertNewChildElement("system-out")
        ->SetText(fmt::format("{} samples of {} agents: {:.3g} {}, worst {:.3g}", figure.samples,
                              figure.judged, figure.value, laws::infoOf(figure.law).unit, figure.worst)
                      .c_str());
  }
}

}  // namespace

void writeJunit(const std::string& file, std::span<const Outcome> outcomes, const Manifest& manifest) {
  tinyxml2::XMLDocument document;
  document.InsertEndChild(document.NewDeclaration());
  XMLElement* suites = document.NewElement("testsuites");
  document.InsertEndChild(suites);
  suites->SetAttribute("name", "skitter validate");
  for (const Outcome& outcome : outcomes) {
    addSuite(*suites, outcome, manifest.json());
    addLaws(*suites, outcome);
  }
  tinyxml2::XMLPrinter printer;
  document.Print(&printer);
  writeText(file, printer.CStr());
}

}  // namespace skitter::app
