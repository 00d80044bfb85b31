:- module(doc_pictures_layers,
          [ layers_picture/1            % +Directory
          ]).
:- use_module(library(filesex), [directory_file_path/3]).
:- use_module(library(process), [process_create/3]).

/** <module> Which module imports which, for doc/architecture.md

*Threading*: the main thread.
*/

%!  layers_picture(+Directory) is det.
%
%   Write layers.svg, by graphviz.

layers_picture(Directory) :-
    module_property(doc_pictures_layers, file(Here)),
    absolute_file_name('../layers.pl', Layers, [relative_to(Here)]),
    directory_file_path(Directory, 'layers.svg', File),
    process_create(path(sh),
                   [ '-c', 'swipl "$0" -- picture | tred | dot -Tsvg > "$1"',
                     Layers, File ],
                   []),
    format('~w~n', [File]).
