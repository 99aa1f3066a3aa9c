"""A drive of one's own: its file, the report on it, the explorer, files for other programs.

`drive_file` and `drive_keys` read and check; `basis`, `verdict` and `report` say what holds; `studies`, `explore` and
`cell` compute what the explorer shows, which `explorer` and `cell_figure` draw; `export` writes points, meshes, tables.
Public: `read_drive_file`.
"""
