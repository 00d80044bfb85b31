:- module(typhon_key_directories,
          [ own_keys/1,                 % ?Directory
            own_keys_begin/1,           % +Directory
            own_keys_end/0,
            keys_sign/3,                % +Directory, +Text, -Signature
            keys_verify/4,              % +Directory, +Text, +Signature, -Holder
            keys_seal/4,                % +Directory, +Text, +Certificate,
                                        % -Sealed
            keys_unseal/3,              % +Directory, +Sealed, -Text
            keys_certificate/2,         % +Directory, -Certificate
            keys_holder/3,              % +Directory, +Certificate, -Holder
            keys_file/3,                % +Directory, +Which, -File
            key_loaded/3                % +Directory, +Which, -Loaded
          ]).

/** <module> Keys: what hosts and authors sign, seal and prove with

The options tls, identity and trail stand on this.  This is the interface of
the layer, which also is loaded when it is used first: so it says itself what
it exports.
*/

:- reexport(keys/key_files, [key_loaded/3, keys_file/3]).
:- reexport(keys/keys,
            [ own_keys/1, own_keys_begin/1, own_keys_end/0, keys_sign/3,
              keys_verify/4, keys_seal/4, keys_unseal/3, keys_certificate/2,
              keys_holder/3 ]).
