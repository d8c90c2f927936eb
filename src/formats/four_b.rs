//! The 4B block: 3B with a radius and a flag, for a control that adds the wire's offset itself.
