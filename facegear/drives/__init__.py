"""A drive of one's own: its file, the report on it, the explorer, files for other programs, the command `facegear`.

`drive_file` reads: `drive_keys` has all keys, of which `keys` says what each is, `file_values` checks them one by one,
`file_teeth` and `file_gearbox` build, `refusals` tells in the file's words what models refuse. `drive_text` writes,
`drive_schema` tells editors and readers the keys, `new_drive` asks for what a file needs. `basis`, `verdict` and
`report` say what holds, `findings` all that a report shows, which `sections` and `page` put in words and
`report_files` write; `sweeps` are maps over any number of a file; `studies`, `explore` and `cell` compute what the
explorer shows, which `explorer` and `cell_figure` draw; `export` writes points, meshes, tables; `command` is the face
of it all on the command line.
Public: `read_drive_file`, `write_drive_file`.
"""
