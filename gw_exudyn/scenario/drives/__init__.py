"""The drives: what moves the wire's proximal end."""
