"""The score display: 160 × 32 dots, their fonts and animations, and the panel that shows them."""
