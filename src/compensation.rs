//! What a control does with G41 and G42, done here: the wire's own path.
