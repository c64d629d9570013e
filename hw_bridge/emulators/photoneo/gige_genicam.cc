#include "hw_bridge/emulators/photoneo/gige_genicam.h"

namespace tubetwin {

const char* const kScannerGenicam = R"xml(<?xml version="1.0" encoding="utf-8"?>
<RegisterDescription ModelName="EmulatedScanner" VendorName="tubetwin"
    StandardNameSpace="GEV" SchemaMajorVersion="1" SchemaMinorVersion="1" SchemaSubMinorVersion="0"
    MajorVersion="1" MinorVersion="0" SubMinorVersion="0" ToolTip="Organised range images"
    ProductGuid="0" VersionGuid="0" xmlns="http://www.genicam.org/GenApi/Version_1_1">

  <Category Name="Root">
    <pFeature>DeviceControl</pFeature>
    <pFeature>AcquisitionControl</pFeature>
    <pFeature>ImageFormatControl</pFeature>
    <pFeature>Scan3dControl</pFeature>
    <pFeature>TransportLayerControl</pFeature>
    <pFeature>UserSetControl</pFeature>
    <pFeature>PhotoneoControl</pFeature>
  </Category>

  <Category Name="DeviceControl">
    <pFeature>DeviceVendorName</pFeature>
    <pFeature>DeviceModelName</pFeature>
    <pFeature>DeviceVersion</pFeature>
    <pFeature>DeviceManufacturerInfo</pFeature>
    <pFeature>DeviceSerialNumber</pFeature>
  </Category>
  <StringReg Name="DeviceVendorName">
    <Address>0x48</Address><Length>32</Length><AccessMode>RO</AccessMode><pPort>Device</pPort>
  </StringReg>
  <StringReg Name="DeviceModelName">
    <Address>0x68</Address><Length>32</Length><AccessMode>RO</AccessMode><pPort>Device</pPort>
  </StringReg>
  <StringReg Name="DeviceVersion">
    <Address>0x88</Address><Length>32</Length><AccessMode>RO</AccessMode><pPort>Device</pPort>
  </StringReg>
  <StringReg Name="DeviceManufacturerInfo">
    <Address>0xa8</Address><Length>48</Length><AccessMode>RO</AccessMode><pPort>Device</pPort>
  </StringReg>
  <StringReg Name="DeviceSerialNumber">
    <Address>0xd8</Address><Length>16</Length><AccessMode>RO</AccessMode><pPort>Device</pPort>
  </StringReg>

  <Category Name="AcquisitionControl">
    <pFeature>AcquisitionMode</pFeature>
    <pFeature>AcquisitionStart</pFeature>
    <pFeature>AcquisitionStop</pFeature>
    <pFeature>TriggerSelector</pFeature>
    <pFeature>TriggerMode</pFeature>
    <pFeature>TriggerSource</pFeature>
    <pFeature>TriggerActivation</pFeature>
    <pFeature>TriggerSoftware</pFeature>
  </Category>
  <Enumeration Name="AcquisitionMode">
    <EnumEntry Name="Continuous"><Value>1</Value></EnumEntry>
    <pValue>AcquisitionModeReg</pValue>
  </Enumeration>
  <IntReg Name="AcquisitionModeReg">
    <Address>0xb000</Address><Length>4</Length><AccessMode>RW</AccessMode><pPort>Device</pPort>
    <Sign>Unsigned</Sign><Endianess>BigEndian</Endianess>
  </IntReg>
  <Command Name="AcquisitionStart">
    <pValue>AcquisitionReg</pValue><CommandValue>1</CommandValue>
  </Command>
  <Command Name="AcquisitionStop">
    <pValue>AcquisitionReg</pValue><CommandValue>0</CommandValue>
  </Command>
  <IntReg Name="AcquisitionReg">
    <Address>0xb004</Address><Length>4</Length><AccessMode>RW</AccessMode><pPort>Device</pPort>
    <Cachable>NoCache</Cachable><Sign>Unsigned</Sign><Endianess>BigEndian</Endianess>
  </IntReg>
  <Enumeration Name="TriggerSelector">
    <EnumEntry Name="FrameStart"><Value>0</Value></EnumEntry>
    <pValue>TriggerSelectorReg</pValue>
  </Enumeration>
  <IntReg Name="TriggerSelectorReg">
    <Address>0xb008</Address><Length>4</Length><AccessMode>RW</AccessMode><pPort>Device</pPort>
    <Sign>Unsigned</Sign><Endianess>BigEndian</Endianess>
  </IntReg>
  <Enumeration Name="TriggerMode">
    <EnumEntry Name="Off"><Value>0</Value></EnumEntry>
    <EnumEntry Name="On"><Value>1</Value></EnumEntry>
    <pValue>TriggerModeReg</pValue>
  </Enumeration>
  <IntReg Name="TriggerModeReg">
    <Address>0xb00c</Address><Length>4</Length><AccessMode>RW</AccessMode><pPort>Device</pPort>
    <Sign>Unsigned</Sign><Endianess>BigEndian</Endianess>
  </IntReg>
  <Enumeration Name="TriggerSource">
    <EnumEntry Name="Line1"><Value>0</Value></EnumEntry>
    <EnumEntry Name="Software"><Value>1</Value></EnumEntry>
    <pValue>TriggerSourceReg</pValue>
  </Enumeration>
  <IntReg Name="TriggerSourceReg">
    <Address>0xb010</Address><Length>4</Length><AccessMode>RW</AccessMode><pPort>Device</pPort>
    <Sign>Unsigned</Sign><Endianess>BigEndian</Endianess>
  </IntReg>
  <Enumeration Name="TriggerActivation">
    <EnumEntry Name="RisingEdge"><Value>0</Value></EnumEntry>
    <EnumEntry Name="FallingEdge"><Value>1</Value></EnumEntry>
    <pValue>TriggerActivationReg</pValue>
  </Enumeration>
  <IntReg Name="TriggerActivationReg">
    <Address>0xb018</Address><Length>4</Length><AccessMode>RW</AccessMode><pPort>Device</pPort>
    <Sign>Unsigned</Sign><Endianess>BigEndian</Endianess>
  </IntReg>
  <Command Name="TriggerSoftware">
    <pValue>TriggerSoftwareReg</pValue><CommandValue>1</CommandValue>
  </Command>
  <IntReg Name="TriggerSoftwareReg">
    <Address>0xb014</Address><Length>4</Length><AccessMode>RW</AccessMode><pPort>Device</pPort>
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
    <Address>0xb020</Address><Length>4</Length><AccessMode>RO</AccessMode><pPort>Device</pPort>
    <Sign>Unsigned</Sign><Endianess>BigEndian</Endianess>
  </IntReg>
  <Integer Name="Height"><pValue>HeightReg</pValue></Integer>
  <IntReg Name="HeightReg">
    <Address>0xb024</Address><Length>4</Length><AccessMode>RO</AccessMode><pPort>Device</pPort>
    <Sign>Unsigned</Sign><Endianess>BigEndian</Endianess>
  </IntReg>
  <Enumeration Name="ComponentSelector">
    <EnumEntry Name="Range"><Value>4</Value></EnumEntry>
    <pValue>ComponentSelectorReg</pValue>
  </Enumeration>
  <IntReg Name="ComponentSelectorReg">
    <Address>0xb030</Address><Length>4</Length><AccessMode>RW</AccessMode><pPort>Device</pPort>
    <Sign>Unsigned</Sign><Endianess>BigEndian</Endianess>
  </IntReg>
  <Boolean Name="ComponentEnable">
    <pValue>ComponentEnableReg</pValue><OnValue>1</OnValue><OffValue>0</OffValue>
  </Boolean>
  <IntReg Name="ComponentEnableReg">
    <Address>0xb034</Address><Length>4</Length><AccessMode>RW</AccessMode><pPort>Device</pPort>
    <Sign>Unsigned</Sign><Endianess>BigEndian</Endianess>
  </IntReg>
  <Integer Name="ComponentIDValue"><Value>4</Value></Integer>
  <Enumeration Name="PixelFormat">
    <EnumEntry Name="Coord3D_ABC32f"><Value>0x026000c0</Value></EnumEntry>
    <pValue>PixelFormatReg</pValue>
  </Enumeration>
  <IntReg Name="PixelFormatReg">
    <Address>0xb028</Address><Length>4</Length><AccessMode>RW</AccessMode><pPort>Device</pPort>
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

  <Category Name="UserSetControl">
    <pFeature>UserSetSelector</pFeature>
    <pFeature>UserSetLoad</pFeature>
    <pFeature>UserSetSave</pFeature>
    <pFeature>UserSetReset</pFeature>
    <pFeature>UserSetDescription</pFeature>
  </Category>
  <Enumeration Name="UserSetSelector">
    <EnumEntry Name="Default"><Value>0</Value></EnumEntry>
    <EnumEntry Name="UserSet0"><Value>1</Value></EnumEntry>
    <EnumEntry Name="UserSet1"><Value>2</Value></EnumEntry>
    <pValue>UserSetSelectorReg</pValue>
  </Enumeration>
  <IntReg Name="UserSetSelectorReg">
    <Address>0xb0a0</Address><Length>4</Length><AccessMode>RW</AccessMode><pPort>Device</pPort>
    <Sign>Unsigned</Sign><Endianess>BigEndian</Endianess>
  </IntReg>
  <Command Name="UserSetLoad">
    <pValue>UserSetLoadReg</pValue><CommandValue>1</CommandValue>
  </Command>
  <IntReg Name="UserSetLoadReg">
    <Address>0xb0a4</Address><Length>4</Length><AccessMode>RW</AccessMode><pPort>Device</pPort>
    <Cachable>NoCache</Cachable><Sign>Unsigned</Sign><Endianess>BigEndian</Endianess>
  </IntReg>
  <Command Name="UserSetSave">
    <pValue>UserSetSaveReg</pValue><CommandValue>1</CommandValue>
  </Command>
  <IntReg Name="UserSetSaveReg">
    <Address>0xb0a8</Address><Length>4</Length><AccessMode>RW</AccessMode><pPort>Device</pPort>
    <Cachable>NoCache</Cachable><Sign>Unsigned</Sign><Endianess>BigEndian</Endianess>
  </IntReg>
  <Command Name="UserSetReset">
    <pValue>UserSetResetReg</pValue><CommandValue>1</CommandValue>
  </Command>
  <IntReg Name="UserSetResetReg">
    <Address>0xb0ac</Address><Length>4</Length><AccessMode>RW</AccessMode><pPort>Device</pPort>
    <Cachable>NoCache</Cachable><Sign>Unsigned</Sign><Endianess>BigEndian</Endianess>
  </IntReg>
  <StringReg Name="UserSetDescription">
    <Address>0xb200</Address><Length>64</Length><AccessMode>RW</AccessMode><pPort>Device</pPort>
    <Cachable>NoCache</Cachable>
  </StringReg>

  <Category Name="PhotoneoControl">
    <pFeature>OperationMode</pFeature>
    <pFeature>CameraExposure</pFeature>
    <pFeature>CameraTextureSource</pFeature>
    <pFeature>NormalsEstimationRadius</pFeature>
    <pFeature>EnableJumboFrames</pFeature>
  </Category>
  <Enumeration Name="OperationMode">
    <EnumEntry Name="Scanner"><Value>0</Value></EnumEntry>
    <EnumEntry Name="Camera"><Value>1</Value></EnumEntry>
    <pValue>OperationModeReg</pValue>
  </Enumeration>
  <IntReg Name="OperationModeReg">
    <Address>0xb240</Address><Length>4</Length><AccessMode>RW</AccessMode><pPort>Device</pPort>
    <Cachable>NoCache</Cachable><Sign>Unsigned</Sign><Endianess>BigEndian</Endianess>
  </IntReg>
  <Float Name="CameraExposure">
    <pValue>CameraExposureReg</pValue><Min>10.24</Min><Max>100.352</Max><Unit>ms</Unit>
  </Float>
  <FloatReg Name="CameraExposureReg">
    <Address>0xb244</Address><Length>4</Length><AccessMode>RW</AccessMode><pPort>Device</pPort>
    <Cachable>NoCache</Cachable><Endianess>BigEndian</Endianess>
  </FloatReg>
  <Enumeration Name="CameraTextureSource">
    <EnumEntry Name="Laser"><Value>0</Value></EnumEntry>
    <EnumEntry Name="LED"><Value>1</Value></EnumEntry>
    <pValue>CameraTextureSourceReg</pValue>
  </Enumeration>
  <IntReg Name="CameraTextureSourceReg">
    <Address>0xb248</Address><Length>4</Length><AccessMode>RW</AccessMode><pPort>Device</pPort>
    <Cachable>NoCache</Cachable><Sign>Unsigned</Sign><Endianess>BigEndian</Endianess>
  </IntReg>
  <Integer Name="NormalsEstimationRadius">
    <pValue>NormalsEstimationRadiusReg</pValue><Min>0</Min><Max>4</Max>
  </Integer>
  <IntReg Name="NormalsEstimationRadiusReg">
    <Address>0xb24c</Address><Length>4</Length><AccessMode>RW</AccessMode><pPort>Device</pPort>
    <Cachable>NoCache</Cachable><Sign>Unsigned</Sign><Endianess>BigEndian</Endianess>
  </IntReg>
  <Boolean Name="EnableJumboFrames">
    <pValue>EnableJumboFramesReg</pValue><OnValue>1</OnValue><OffValue>0</OffValue>
  </Boolean>
  <IntReg Name="EnableJumboFramesReg">
    <Address>0xb250</Address><Length>4</Length><AccessMode>RW</AccessMode><pPort>Device</pPort>
    <Cachable>NoCache</Cachable><Sign>Unsigned</Sign><Endianess>BigEndian</Endianess>
  </IntReg>

  <Port Name="Device"></Port>
</RegisterDescription>
)xml";

}  // namespace tubetwin
