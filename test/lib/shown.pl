:- module(test_shown,
          [ shown/3,                    % +Document, +Begin, -Text
            shown_in_file/3             % +Document, +Begin, +File
          ]).

/** <module> Blocks of documents

*Threading*: reads and writes files.
*/

:- use_module(common, [project_file/2]).
:- use_module(library(readutil), [read_file_to_string/3]).

%!  shown(+Document, +Begin, -Text:string) is semidet.
%
%   Text follows the first Begin in Document, a file of the project, up to the
%   end of the block.

shown(Document, Begin, Text) :-
    project_file(Document, File),
    read_file_to_string(File, All, [encoding(utf8)]),
    once(sub_string(All, Before, Length, _, Begin)),
    Start is Before+Length,
    sub_string(All, Start, _, 0, Rest),
    once(sub_string(Rest, End, _, _, "\n```")),
    sub_string(Rest, 0, End, _, Text).

%!  shown_in_file(+Document, +Begin, +File) is semidet.
%
%   As shown/3; the text is in File then.

shown_in_file(Document, Begin, File) :-
    shown(Document, Begin, Text),
    setup_call_cleanup(open(File, write, Out, [encoding(utf8)]),
                       write(Out, Text),
                       close(Out)).
