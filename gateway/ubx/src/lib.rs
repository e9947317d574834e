//! u-blox UBX frames: NAV-PVT and NAV-RELPOSNED, both ways.
