//! ezdxf against the reader and the writer of drawings.
