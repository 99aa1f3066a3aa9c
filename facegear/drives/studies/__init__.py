"""What the live explorers explore, one file a study: `drive`, `teeth`, `gearbox`, `oscillator`.

`study` says what a study is; `controls`, `contact` and `force` are what several have in common.
"""
