#include "bindings/python/bind.h"

namespace skitter::python {
namespace {

py::dict describe(const DeviceReport& report) {
  using namespace py::literals;
  return py::dict("name"_a = report.name, "driver"_a = report.driver, "index"_a = report.index,
                  "type"_a = report.typeName(), "suitable"_a = report.suitable, "chosen"_a = report.chosen,
                  "whyNot"_a = report.whyNot, "availableBytes"_a = report.limits.availableBytes);
}

}  // namespace

void bindDevice(py::module_& module) {
  using namespace py::literals;
  py::class_<SharedDevice, std::shared_ptr<SharedDevice>>(
      module, "Device", "A Vulkan device, which lives as long as anything that was made on it.")
      .def(py::init([](const std::optional<std::string>& name, bool validation) {
             DeviceRequest request;
             request.device = name;
             request.validation = validation;
             const py::gil_scoped_release release;
             return std::make_shared<SharedDevice>(Device::create(request));
           }),
           "name"_a = py::none(), py::kw_only(), "validation"_a = false,
           "The device whose name has `name` in it, in any case, or whose index it is; the best suitable one "
           "where there is none. With `validation`, the validation layer watches all that is done on it. "
           "Raises "
           "DeviceError.")
      .def_static(
          "list",
          [] {
            std::vector<DeviceReport> reports;
            {
              const py::gil_scoped_release release;
              reports = listDevices();
            }
            py::list described;
            for (const DeviceReport& report : reports) described.append(describe(report));
            return described;
          },
          "Every Vulkan device of this machine, a dict each: name, driver, index, type (\"discrete\", "
          "\"integrated\", \"virtual\", \"cpu\" or \"other\"), suitable, chosen (that Device() takes it), "
          "whyNot, "
          "availableBytes.")
      .def_property_readonly(
          "name", [](const SharedDevice& self) { return self.device.report().name; }, "As Vulkan names it.")
      .def_property_readonly(
          "report", [](const SharedDevice& self) { return describe(self.device.report()); },
          "What Device.list() tells of it.")
      .def(
          "validation_messages",
          [](const SharedDevice& self) {
            std::vector<std::string> texts;
            for (const ValidationMessage& message : self.device.validationMessages())
              texts.push_back(message.text);
            return texts;
          },
          "What the validation layer has complained about. Empty without `validation`.")
      .def("__repr__", [](const SharedDevice& self) {
        return fmt::format("<skitter.Device {}>", self.device.report().name);
      });
}

}  // namespace skitter::python
