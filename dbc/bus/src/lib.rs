//! CAN buses behind one trait: virtual and SocketCAN, with a candump recorder.
