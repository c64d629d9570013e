#include "hw_bridge/emulators/photoneo/gige_genicam.h"

#include <cstdint>
#include <cstdio>
#include <utility>
#include <vector>

#include "hw_bridge/emulators/photoneo/gige_registers.h"

namespace tubetwin {
namespace {

std::string Hex(std::uint32_t value) {
  char text[16];
  std::snprintf(text, sizeof text, "0x%x", value);
  return text;
}

std::string Tag(const std::string& name, const std::string& content) {
  return "<" + name + ">" + content + "</" + name + ">";
}
std::string Number(const std::string& tag, std::int64_t value) {
  return Tag(tag, std::to_string(value));
}
std::string Node(const std::string& kind, const std::string& name, const std::string& content) {
  return "<" + kind + " Name=\"" + name + "\">" + content + "</" + kind + ">\n";
}

enum class Access { kRead, kWrite };
/// What every register says. Nothing is kept by clients: what one register is may follow from
/// others.
std::string At(std::uint32_t address, int bytes, Access access) {
  return Tag("Address", Hex(address)) + Number("Length", bytes) +
         Tag("AccessMode", access == Access::kRead ? "RO" : "RW") + Tag("pPort", "Device") +
         Tag("Cachable", "NoCache");
}
constexpr char kBigEndian[] = "<Endianess>BigEndian</Endianess>";
constexpr char kUnsigned[] = "<Sign>Unsigned</Sign>";

std::string Word(const std::string& name, std::uint32_t address, Access access,
                 const std::string& more = "") {
  return Node("IntReg", name, At(address, 4, access) + more + kUnsigned + kBigEndian);
}
/// Of each component: the selected one's.
std::string BlockWord(const std::string& name, std::uint32_t offset, Access access) {
  return Word(name, gige::kComponents + offset, access, Tag("pAddress", "ComponentBlock"));
}
std::string Text(const std::string& name, std::uint32_t address, std::uint32_t end, Access access) {
  return Node("StringReg", name, At(address, static_cast<int>(end - address), access));
}
std::string FloatWord(const std::string& name, std::uint32_t address, Access access) {
  return Node("FloatReg", name, At(address, 4, access) + kBigEndian);
}

std::string Constant(const std::string& name, std::int64_t value) {
  return Node("Integer", name, Number("Value", value));
}
std::string Told(const std::string& name, std::uint32_t address) {
  return Node("Integer", name, Tag("pValue", name + "Reg")) +
         Word(name + "Reg", address, Access::kRead);
}
std::string Command(const std::string& name, std::uint32_t address) {
  return Node("Command", name, Tag("pValue", name + "Reg") + Number("CommandValue", 1)) +
         Word(name + "Reg", address, Access::kWrite);
}
std::string Switch(const std::string& name, const std::string& place) {
  return Node("Boolean", name, place + Number("OnValue", 1) + Number("OffValue", 0));
}

struct Entry {
  std::string name;
  std::uint32_t value = 0;
  std::string available = {};  ///< Node that says whether it can be chosen; empty: always.
};
std::string Entries(const std::vector<Entry>& entries) {
  std::string out;
  for (const Entry& each : entries) {
    const std::string when = each.available.empty() ? "" : Tag("pIsAvailable", each.available);
    out += Node("EnumEntry", each.name, when + Tag("Value", Hex(each.value)));
  }
  return out;
}
std::string Choice(const std::string& name, std::uint32_t address,
                   const std::vector<Entry>& entries, const std::string& more = "") {
  return Node("Enumeration", name, Entries(entries) + Tag("pValue", name + "Reg") + more) +
         Word(name + "Reg", address, Access::kWrite);
}

std::string Category(const std::string& name, const std::vector<std::string>& features) {
  std::string out;
  for (const std::string& feature : features) out += Tag("pFeature", feature);
  return Node("Category", name, out);
}

std::string DeviceControl() {
  return Category("DeviceControl",
                  {"DeviceVendorName", "DeviceModelName", "DeviceVersion", "DeviceFirmwareVersion",
                   "DeviceManufacturerInfo", "DeviceSerialNumber", "DeviceUserID", "DeviceReset"}) +
         Text("DeviceVendorName", gige::kVendor, gige::kModel, Access::kRead) +
         Text("DeviceModelName", gige::kModel, gige::kDeviceVersion, Access::kRead) +
         Text("DeviceVersion", gige::kDeviceVersion, gige::kManufacturerInfo, Access::kRead) +
         Text("DeviceFirmwareVersion", gige::kDeviceVersion, gige::kManufacturerInfo,
              Access::kRead) +
         Text("DeviceManufacturerInfo", gige::kManufacturerInfo, gige::kSerial, Access::kRead) +
         Text("DeviceSerialNumber", gige::kSerial, gige::kUserName, Access::kRead) +
         Text("DeviceUserID", gige::kUserName, gige::kUserNameEnd, Access::kWrite) +
         Command("DeviceReset", gige::kDeviceReset);
}

std::string AcquisitionControl() {
  const std::string acquisition = Tag("pValue", "AcquisitionReg");
  return Category("AcquisitionControl",
                  {"AcquisitionMode", "AcquisitionStart", "AcquisitionStop", "TriggerSelector",
                   "TriggerMode", "TriggerSource", "TriggerActivation", "TriggerSoftware"}) +
         Choice("AcquisitionMode", gige::kAcquisitionMode, {{"Continuous", 1}}) +
         Node("Command", "AcquisitionStart", acquisition + Number("CommandValue", 1)) +
         Node("Command", "AcquisitionStop", acquisition + Number("CommandValue", 0)) +
         Word("AcquisitionReg", gige::kAcquisition, Access::kWrite) +
         Choice("TriggerSelector", gige::kTriggerSelector, {{"FrameStart", 0}}) +
         Choice("TriggerMode", gige::kTriggerMode, {{"Off", 0}, {"On", 1}}) +
         Choice("TriggerSource", gige::kTriggerSource, {{"Line1", 0}, {"Software", 1}}) +
         Choice("TriggerActivation", gige::kTriggerActivation,
                {{"RisingEdge", 0}, {"FallingEdge", 1}}) +
         Command("TriggerSoftware", gige::kTrigger);
}

/// A node that is 1 when the formula of C, the selected component, and M, the output mode, holds.
std::string Holds(const std::string& name, const std::string& formula) {
  return Node("IntSwissKnife", name,
              "<pVariable Name=\"C\">ComponentSelectorReg</pVariable>"
              "<pVariable Name=\"M\">Scan3dOutputModeReg</pVariable>" +
                  Tag("Formula", formula));
}

std::string PixelFormats() {
  return Node("Enumeration", "PixelFormat",
              Entries({{"Mono10", kPixelMono10, "IsIntensity"},
                       {"Coord3D_ABC32f", kPixelCoord3dAbc32f, "IsPointOrNormal"},
                       {"Coord3D_C32f", kPixelCoord3dC32f, "IsDepth"},
                       {"Confidence8", kPixelConfidence8, "IsConfidence"},
                       {"Coord3D_A32f", kPixelCoord3dA32f, "IsMapA"},
                       {"Coord3D_B32f", kPixelCoord3dB32f, "IsMapB"},
                       {"Coord3D_AC8", kPixelCoord3dAc8, "IsNormal"}}) +
                  Tag("pValue", "PixelFormatReg")) +
         BlockWord("PixelFormatReg", gige::kPixelFormat, Access::kWrite) +
         Holds("IsIntensity", "C = 0") +
         Holds("IsPointOrNormal", "(C = 5) || ((C = 1) &amp;&amp; (M = 0))") +
         Holds("IsDepth", "(C = 1) &amp;&amp; (M = 1)") + Holds("IsConfidence", "C = 2") +
         Holds("IsMapA", "C = 3") + Holds("IsMapB", "C = 4") + Holds("IsNormal", "C = 5");
}

std::string ImageFormatControl() {
  std::vector<Entry> components;
  for (std::uint32_t i = 0; i < kScanComponents; ++i) {
    components.push_back({InfoOf(static_cast<ScanComponent>(i)).name, i});
  }
  const std::string selected = Tag("pSelected", "ComponentEnable") +
                               Tag("pSelected", "ComponentIDValue") +
                               Tag("pSelected", "PixelFormat");
  const auto same = [](const char* name, const char* of) {
    return Node("Integer", name, Tag("pValue", of));
  };
  return Category("ImageFormatControl",
                  {"Width", "Height", "SensorWidth", "SensorHeight", "WidthMax", "HeightMax",
                   "OffsetX", "OffsetY", "ComponentSelector", "ComponentEnable", "ComponentIDValue",
                   "PixelFormat"}) +
         Told("Width", gige::kWidth) + Told("Height", gige::kHeight) +
         same("SensorWidth", "WidthReg") + same("SensorHeight", "HeightReg") +
         same("WidthMax", "WidthReg") + same("HeightMax", "HeightReg") + Constant("OffsetX", 0) +
         Constant("OffsetY", 0) +
         Choice("ComponentSelector", gige::kComponent, components, selected) +
         Node("IntSwissKnife", "ComponentBlock",
              "<pVariable Name=\"C\">ComponentSelectorReg</pVariable>" +
                  Tag("Formula", "C * " + std::to_string(gige::kComponentBlock))) +
         Switch("ComponentEnable", Tag("pValue", "ComponentEnableReg")) +
         BlockWord("ComponentEnableReg", gige::kEnabled, Access::kWrite) +
         same("ComponentIDValue", "ComponentIDValueReg") +
         BlockWord("ComponentIDValueReg", gige::kComponentId, Access::kRead) + PixelFormats();
}

std::string Scan3dControl() {
  return Category("Scan3dControl",
                  {"Scan3dOutputMode", "Scan3dDistanceUnit", "Scan3dFocalLength",
                   "Scan3dAspectRatio", "Scan3dPrincipalPointU", "Scan3dPrincipalPointV"}) +
         Choice("Scan3dOutputMode", gige::kOutputMode,
                {{"CalibratedABC_Grid", 0}, {"ProjectedC", 1}}) +
         Node("Enumeration", "Scan3dDistanceUnit",
              Entries({{"Millimeter", 0}}) + Number("Value", 0)) +
         FloatWord("Scan3dFocalLength", gige::kFocal, Access::kRead) +
         Node("Float", "Scan3dAspectRatio", Number("Value", 1)) +
         FloatWord("Scan3dPrincipalPointU", gige::kCentreU, Access::kRead) +
         FloatWord("Scan3dPrincipalPointV", gige::kCentreV, Access::kRead);
}

std::string TransportLayerControl() {
  const std::string locked = Tag("pIsLocked", "TLParamsLocked");
  const auto bits = [](const char* name, const std::string& which) {
    return Node("MaskedIntReg", name,
                At(gige::kPacketSize, 4, Access::kWrite) + which + kUnsigned + kBigEndian);
  };
  return Category("TransportLayerControl",
                  {"PayloadSize", "GevSCPSPacketSize", "GevSCPSFireTestPacket",
                   "GevSCPSDoNotFragment", "TLParamsLocked"}) +
         Told("PayloadSize", gige::kPayloadSize) +
         Node("Integer", "GevSCPSPacketSize",
              locked + Tag("pValue", "PacketSizeReg") + Number("Min", gige::kSmallestPacket) +
                  Tag("pMax", "LargestPacketReg") + Number("Inc", 4)) +
         bits("PacketSizeReg", Number("LSB", 31) + Number("MSB", 16)) +
         Word("LargestPacketReg", gige::kLargestPacket, Access::kRead) +
         Node("Command", "GevSCPSFireTestPacket",
              locked + Tag("pValue", "FireTestPacketReg") + Number("CommandValue", 1)) +
         bits("FireTestPacketReg", Number("Bit", 0)) +
         Switch("GevSCPSDoNotFragment", locked + Tag("pValue", "DoNotFragmentReg")) +
         bits("DoNotFragmentReg", Number("Bit", 1)) +
         Node("Integer", "TLParamsLocked",
              Tag("pValue", "TLParamsLockedReg") + Number("Min", 0) + Number("Max", 1)) +
         Word("TLParamsLockedReg", gige::kLocked, Access::kWrite);
}

std::string UserSetControl() {
  std::vector<Entry> features;
  for (const char* feature :
       {"ComponentEnable", "PixelFormat", "Scan3dOutputMode", "AcquisitionMode", "TriggerSelector",
        "TriggerMode", "TriggerSource", "TriggerActivation", "OperationMode", "CameraExposure",
        "CameraTextureSource", "NormalsEstimationRadius", "EnableJumboFrames",
        "UserSetDescription"}) {
    features.push_back({feature, static_cast<std::uint32_t>(features.size())});
  }
  const std::vector<Entry> sets = {{"Default", 0}, {"UserSet0", 1}, {"UserSet1", 2}};
  return Category("UserSetControl",
                  {"UserSetSelector", "UserSetLoad", "UserSetSave", "UserSetReset",
                   "UserSetDefault", "UserSetDescription", "UserSetFeatureSelector"}) +
         Choice("UserSetSelector", gige::kUserSet, sets) +
         Command("UserSetLoad", gige::kUserSetLoad) + Command("UserSetSave", gige::kUserSetSave) +
         Command("UserSetReset", gige::kUserSetReset) +
         Choice("UserSetDefault", gige::kUserSetDefault, sets) +
         Text("UserSetDescription", gige::kDescription, gige::kDescriptionEnd, Access::kWrite) +
         Node("Enumeration", "UserSetFeatureSelector", Entries(features) + Number("Value", 0));
}

std::string PhotoneoControl() {
  return Category(
             "PhotoneoControl",
             {"OperationMode", "CameraExposure", "CameraTextureSource", "NormalsEstimationRadius",
              "EnableJumboFrames", "IsPhoXi3DScanner_Val", "IsMotionCam3D_Val",
              "IsMotionCam3DColor_Val", "IsAlphaScanner_Val", "IsNotAlphaScanner_Val"}) +
         Choice("OperationMode", gige::kOperationMode, {{"Scanner", 0}, {"Camera", 1}}) +
         Node("Float", "CameraExposure",
              Tag("pValue", "CameraExposureReg") + Tag("Min", "10.24") + Tag("Max", "100.352") +
                  Tag("Unit", "ms")) +
         FloatWord("CameraExposureReg", gige::kExposure, Access::kWrite) +
         Choice("CameraTextureSource", gige::kTextureSource, {{"Laser", 0}, {"LED", 1}}) +
         Node("Integer", "NormalsEstimationRadius",
              Tag("pValue", "NormalsRadiusReg") + Number("Min", 0) + Number("Max", 4)) +
         Word("NormalsRadiusReg", gige::kNormalsRadius, Access::kWrite) +
         Switch("EnableJumboFrames", Tag("pValue", "JumboFramesReg")) +
         Word("JumboFramesReg", gige::kJumboFrames, Access::kWrite) +
         Constant("IsPhoXi3DScanner_Val", 1) + Constant("IsMotionCam3D_Val", 0) +
         Constant("IsMotionCam3DColor_Val", 0) + Constant("IsAlphaScanner_Val", 0) +
         Constant("IsNotAlphaScanner_Val", 1);
}

}  // namespace

std::string ScannerGenicam() {
  return R"xml(<?xml version="1.0" encoding="utf-8"?>
<RegisterDescription ModelName="PhoXi3DScan" VendorName="Photoneo"
    StandardNameSpace="GEV" SchemaMajorVersion="1" SchemaMinorVersion="1" SchemaSubMinorVersion="0"
    MajorVersion="1" MinorVersion="0" SubMinorVersion="0" ToolTip="Emulated scanner"
    ProductGuid="0" VersionGuid="0" xmlns="http://www.genicam.org/GenApi/Version_1_1">
)xml" +
         Category("Root",
                  {"DeviceControl", "AcquisitionControl", "ImageFormatControl", "Scan3dControl",
                   "TransportLayerControl", "UserSetControl", "PhotoneoControl"}) +
         DeviceControl() + AcquisitionControl() + ImageFormatControl() + Scan3dControl() +
         TransportLayerControl() + UserSetControl() + PhotoneoControl() +
         "<Port Name=\"Device\"></Port>\n</RegisterDescription>\n";
}

}  // namespace tubetwin
