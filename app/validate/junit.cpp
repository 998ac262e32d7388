#include <fmt/format.h>
#include <tinyxml2.h>

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

XMLElement& addCase(XMLElement& suite, const std::string& name) {
  XMLElement& test = *suite.InsertNewChildElement("testcase");
  test.SetAttribute("classname", "skitter.validate");
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

}  // namespace

void writeJunit(const std::string& file, std::span<const Outcome> outcomes, const Manifest& manifest) {
  tinyxml2::XMLDocument document;
  document.InsertEndChild(document.NewDeclaration());
  XMLElement* suites = document.NewElement("testsuites");
  document.InsertEndChild(suites);
  suites->SetAttribute("name", "skitter validate");
  for (const Outcome& outcome : outcomes) addSuite(*suites, outcome, manifest.json());
  tinyxml2::XMLPrinter printer;
  document.Print(&printer);
  writeText(file, printer.CStr());
}

}  // namespace skitter::app
