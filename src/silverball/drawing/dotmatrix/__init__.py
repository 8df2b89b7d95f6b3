"""The score display: 160 × 32 dots, its fonts and animations, and how the dots become light."""
