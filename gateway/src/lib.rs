//! Policy actions to CAN frames and back, under the safety kernel.
