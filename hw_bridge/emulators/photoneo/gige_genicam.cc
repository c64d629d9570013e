#include "hw_bridge/emulators/photoneo/gige_genicam.h"

namespace tubetwin {

const char* const kScannerGenicam = R"xml(<?xml version="1.0" encoding="utf-8"?>
<RegisterDescription ModelName="EmulatedScanner" VendorName="tubetwin"
    StandardNameSpace="GEV" SchemaMajorVersion="1" SchemaMinorVersion="1" SchemaSubMinorVersion="0"
    MajorVersion="1" MinorVersion="0" SubMinorVersion="0" ToolTip="Organised range images"
    ProductGuid="0" VersionGuid="0" xmlns="http://www.genicam.org/GenApi/Version_1_1">

  <Category Name="Root">
    <pFeature>AcquisitionControl</pFeature>
    <pFeature>ImageFormatControl</pFeature>
    <pFeature>Scan3dControl</pFeature>
    <pFeature>TransportLayerControl</pFeature>
  </Category>

  <Category Name="AcquisitionControl">
    <pFeature>AcquisitionMode</pFeature>
    <pFeature>AcquisitionStart</pFeature>
    <pFeature>AcquisitionStop</pFeature>
    <pFeature>TriggerSelector</pFeature>
    <pFeature>TriggerMode</pFeature>
    <pFeature>TriggerSource</pFeature>
    <pFeature>TriggerSoftware</pFeature>
  </Category>
  <Enumeration Name="AcquisitionMode">
    <EnumEntry Name="Continuous"><Value>1</Value></EnumEntry>
    <pValue>AcquisitionModeReg</pValue>
  </Enumeration>
  <IntReg Name="AcquisitionModeReg">
    <Address>0x12c</Address><Length>4</Length><AccessMode>RW</AccessMode><pPort>Device</pPort>
    <Sign>Unsigned</Sign><Endianess>BigEndian</Endianess>
  </IntReg>
  <Command Name="AcquisitionStart">
    <pValue>AcquisitionReg</pValue><CommandValue>1</CommandValue>
  </Command>
  <Command Name="AcquisitionStop">
    <pValue>AcquisitionReg</pValue><CommandValue>0</CommandValue>
  </Command>
  <IntReg Name="AcquisitionReg">
    <Address>0x124</Address><Length>4</Length><AccessMode>RW</AccessMode><pPort>Device</pPort>
    <Cachable>NoCache</Cachable><Sign>Unsigned</Sign><Endianess>BigEndian</Endianess>
  </IntReg>
  <Enumeration Name="TriggerSelector">
    <EnumEntry Name="FrameStart"><Value>0</Value></EnumEntry>
    <pValue>TriggerSelectorReg</pValue>
  </Enumeration>
  <IntReg Name="TriggerSelectorReg">
    <Address>0x410</Address><Length>4</Length><AccessMode>RW</AccessMode><pPort>Device</pPort>
    <Sign>Unsigned</Sign><Endianess>BigEndian</Endianess>
  </IntReg>
  <Enumeration Name="TriggerMode">
    <EnumEntry Name="Off"><Value>0</Value></EnumEntry>
    <EnumEntry Name="On"><Value>1</Value></EnumEntry>
    <pValue>TriggerModeReg</pValue>
  </Enumeration>
  <IntReg Name="TriggerModeReg">
    <Address>0x300</Address><Length>4</Length><AccessMode>RW</AccessMode><pPort>Device</pPort>
    <Sign>Unsigned</Sign><Endianess>BigEndian</Endianess>
  </IntReg>
  <Enumeration Name="TriggerSource">
    <EnumEntry Name="Line1"><Value>0</Value></EnumEntry>
    <EnumEntry Name="Software"><Value>1</Value></EnumEntry>
    <pValue>TriggerSourceReg</pValue>
  </Enumeration>
  <IntReg Name="TriggerSourceReg">
    <Address>0x304</Address><Length>4</Length><AccessMode>RW</AccessMode><pPort>Device</pPort>
    <Sign>Unsigned</Sign><Endianess>BigEndian</Endianess>
  </IntReg>
  <Command Name="TriggerSoftware">
    <pValue>TriggerSoftwareReg</pValue><CommandValue>1</CommandValue>
  </Command>
  <IntReg Name="TriggerSoftwareReg">
    <Address>0x400</Address><Length>4</Length><AccessMode>RW</AccessMode><pPort>Device</pPort>
    <Cachable>NoCache</Cachable><Sign>Unsigned</Sign><Endianess>BigEndian</Endianess>
  </IntReg>

  <Category Name="ImageFormatControl">
    <pFeature>Width</pFeature>
    <pFeature>Height</pFeature>
    <pFeature>ComponentSelector</pFeature>
    <pFeature>ComponentEnable</pFeature>
    <pFeature>ComponentIDValue</pFeature>
    <pFeature>PixelFormat</pFeature>
  </Category>
  <Integer Name="Width"><pValue>WidthReg</pValue></Integer>
  <IntReg Name="WidthReg">
    <Address>0x100</Address><Length>4</Length><AccessMode>RO</AccessMode><pPort>Device</pPort>
    <Sign>Unsigned</Sign><Endianess>BigEndian</Endianess>
  </IntReg>
  <Integer Name="Height"><pValue>HeightReg</pValue></Integer>
  <IntReg Name="HeightReg">
    <Address>0x104</Address><Length>4</Length><AccessMode>RO</AccessMode><pPort>Device</pPort>
    <Sign>Unsigned</Sign><Endianess>BigEndian</Endianess>
  </IntReg>
  <Enumeration Name="ComponentSelector">
    <EnumEntry Name="Range"><Value>4</Value></EnumEntry>
    <pValue>ComponentSelectorReg</pValue>
  </Enumeration>
  <IntReg Name="ComponentSelectorReg">
    <Address>0x404</Address><Length>4</Length><AccessMode>RW</AccessMode><pPort>Device</pPort>
    <Sign>Unsigned</Sign><Endianess>BigEndian</Endianess>
  </IntReg>
  <Boolean Name="ComponentEnable">
    <pValue>ComponentEnableReg</pValue><OnValue>1</OnValue><OffValue>0</OffValue>
  </Boolean>
  <IntReg Name="ComponentEnableReg">
    <Address>0x408</Address><Length>4</Length><AccessMode>RW</AccessMode><pPort>Device</pPort>
    <Sign>Unsigned</Sign><Endianess>BigEndian</Endianess>
  </IntReg>
  <Integer Name="ComponentIDValue"><Value>4</Value></Integer>
  <Enumeration Name="PixelFormat">
    <EnumEntry Name="Coord3D_ABC32f"><Value>0x026000c0</Value></EnumEntry>
    <pValue>PixelFormatReg</pValue>
  </Enumeration>
  <IntReg Name="PixelFormatReg">
    <Address>0x128</Address><Length>4</Length><AccessMode>RW</AccessMode><pPort>Device</pPort>
    <Sign>Unsigned</Sign><Endianess>BigEndian</Endianess>
  </IntReg>

  <Category Name="Scan3dControl">
    <pFeature>Scan3dOutputMode</pFeature>
    <pFeature>Scan3dDistanceUnit</pFeature>
  </Category>
  <Enumeration Name="Scan3dOutputMode">
    <EnumEntry Name="CalibratedABC_Grid"><Value>0</Value></EnumEntry>
    <Value>0</Value>
  </Enumeration>
  <Enumeration Name="Scan3dDistanceUnit">
    <EnumEntry Name="Millimeter"><Value>0</Value></EnumEntry>
    <Value>0</Value>
  </Enumeration>

  <Category Name="TransportLayerControl"><pFeature>PayloadSize</pFeature></Category>
  <Integer Name="PayloadSize"><pValue>PayloadSizeCalc</pValue></Integer>
  <IntSwissKnife Name="PayloadSizeCalc">
    <pVariable Name="W">Width</pVariable>
    <pVariable Name="H">Height</pVariable>
    <Formula>W * H * 12</Formula>
  </IntSwissKnife>

  <Port Name="Device"></Port>
</RegisterDescription>
)xml";

}  // namespace tubetwin
